#pragma once
#include <string>

#include "interfaces/values.hpp"

namespace plant {

/// A change that is reported once.
struct Notice {
  erp::Severity severity;
  std::string subject;  ///< actuator, or number of actuators
  std::string code;
  std::string text;
};

}  // namespace plant
