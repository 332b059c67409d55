#pragma once
#include <CLI/CLI.hpp>
#include <iosfwd>

namespace launch {

/// A script for bash-completion. It offers verbs, after `-` the options of a verb, otherwise file
/// names.
void print_bash_completion(const CLI::App& app, std::ostream& out);

}  // namespace launch
