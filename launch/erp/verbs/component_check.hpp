#pragma once
#include <string>
#include <vector>

/// Runs the program of a component with --check or --describe, which do not start the component.
namespace launch {

/// Runs `argv --check`. A component exits with 0, or with 2 and its errors on stderr. Returns these
/// errors. If there are none, returns "" and prints the component's warnings on stderr. Kills a
/// program that does not exit within 10 s and returns an error. Throws std::system_error when the
/// program cannot be executed.
std::string check_component(std::vector<std::string> argv);

/// Runs `program --describe` and returns its output, the table of the component's parameters.
/// Throws std::invalid_argument if it fails or does not exit within 10 s, and std::system_error
/// when the program cannot be executed.
std::string describe_component(const std::string& program);

}  // namespace launch
