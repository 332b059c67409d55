#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "interfaces/values.hpp"

namespace plant {

/// Something worth saying once.
struct Notice {
  erp::Severity severity;
  std::string subject;  ///< actuator, or how many of them
  std::string code;
  std::string text;
};

/// Notices that say the same of three or more actuators become one that counts them; of fewer than
/// all `actuators` it names the first. Otherwise in the order given. Pure.
std::vector<Notice> together(std::vector<Notice> notices, std::size_t actuators);

}  // namespace plant
