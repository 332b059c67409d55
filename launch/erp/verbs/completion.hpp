#pragma once
#include <CLI/CLI.hpp>
#include <iosfwd>

namespace launch {

/// A script for bash-completion that offers verbs, and after `-` the options of a verb; files elsewhere.
void print_bash_completion(const CLI::App& app, std::ostream& out);

}  // namespace launch
