#pragma once
#include <CLI/CLI.hpp>
#include <iosfwd>
#include <string>

namespace launch {

/// The manual page of a command line, in the macros man(7): every verb with its options, in the order and groups of
/// `--help`. `version`: of the program, for the footer.
void print_man_page(const CLI::App& app, const std::string& version, std::ostream& out);

}  // namespace launch
