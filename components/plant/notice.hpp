#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "interfaces/values.hpp"

namespace plant {

/// A change that is reported once.
struct Notice {
  erp::Severity severity;
  std::string subject;  ///< actuator, or number of actuators
  std::string code;
  std::string text;
};

/// Merges notices that differ only in the actuator, if there are three or more, into one that states
/// their number. If they are fewer than `actuators`, the number of all actuators, it also names the
/// first three. Keeps the order otherwise.
std::vector<Notice> merge_similar(std::vector<Notice> notices, std::size_t actuators);

}  // namespace plant
