#pragma once
#include <stdexcept>

#include "interfaces/robot/actuator.hpp"

namespace sim {

/// work(); an std::invalid_argument that it throws says of which actuator it is.
template <class Work>
auto of_actuator(const erp::Actuator& actuator, Work work) try {
  return work();
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument("actuator \"" + actuator.name + "\": " + error.what());
}

}  // namespace sim
