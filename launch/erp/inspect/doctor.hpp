#pragma once
#include <iosfwd>
#include <string>
#include <vector>

/// `erp doctor`: whether this computer can run and control a robot.
namespace launch {

/// One property of the computer.
struct Finding {
  enum class Grade { good, warning, problem };
  Grade grade;
  std::string what, state;
  std::string remedy;  ///< empty if good
};

/// Examines programs, real-time permission, network, bus, clocks, CAN interfaces and disk. `robot`: its robot.xml, to compare the
/// bit rates of its buses; empty: none. Throws xml::Errors when it is wrong.
std::vector<Finding> examine(const std::string& robot);

/// Prints all findings with their remedies. Returns 1 if one of them is a problem, otherwise 0.
int doctor(const std::string& robot, std::ostream& out);

}  // namespace launch
