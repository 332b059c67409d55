#pragma once
#include <string>
#include <vector>

/// Requests to the program of a component, which answers without starting the component.
namespace launch {

/// Runs `argv --check`. A component exits with 0, or with 2 and its errors on stderr.
/// Returns these errors, "" if there are none; then prints its warnings on stderr. A program that does not exit within 10 s is killed
/// and reported as an error. Throws std::system_error when the program cannot be executed.
std::string check_component(std::vector<std::string> argv);

/// Runs `program --describe` and returns its output, the table of the component's parameters. Throws
/// std::invalid_argument if it fails or does not exit within 10 s, and as check_component.
std::string describe_component(const std::string& program);

}  // namespace launch
