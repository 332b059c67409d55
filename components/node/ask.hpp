#pragma once
#include <string>

#include "components/node/node.hpp"
#include "interfaces/values.hpp"

namespace node {

/// One actuator more in a command. V, m, A or N, as the mode says.
inline void ask(erp::ActuatorCommand& command, const std::string& actuator, erp::Mode mode,
                double reference) {
  erp::ActuatorReference one{};
  erp::assign(one.name, actuator);
  one.mode = static_cast<std::uint8_t>(mode);
  one.reference = reference;
  erp::append(command.actuators, one);
}

/// Writes a file; that it could not is reported, and the controller goes on.
void write_or_report(Node& node, const std::string& file, auto write) {
  try {
    write(file);
  } catch (const std::exception& e) {
    node.report(erp::Severity::fault, file, "unwritten", e.what());
  }
}

}  // namespace node
