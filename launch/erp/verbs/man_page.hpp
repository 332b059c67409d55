#pragma once
#include <CLI/CLI.hpp>
#include <iosfwd>

namespace launch {

/// Prints the manual page of a command line in the format man(7): every verb with its options, in
/// the order and groups of `--help`.
void print_man_page(const CLI::App& app, std::ostream& out);

}  // namespace launch
