#pragma once
#include <CLI/CLI.hpp>
#include <iosfwd>

namespace launch {

/// The manual page of a command line, in the macros man(7): every verb with its options, in the order and groups of
/// `--help`.
void print_man_page(const CLI::App& app, std::ostream& out);

}  // namespace launch
