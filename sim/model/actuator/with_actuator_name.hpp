#pragma once
#include <stdexcept>

#include "interfaces/robot/actuator.hpp"

namespace sim {

/// Calls work(). Adds the actuator's name to the message of an std::invalid_argument that it throws.
template <class Work>
auto with_actuator_name(const erp::Actuator& actuator, Work work) try {
  return work();
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument("actuator \"" + actuator.name + "\": " + error.what());
}

}  // namespace sim
