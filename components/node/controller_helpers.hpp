#pragma once
#include <string>

#include "components/node/node.hpp"
#include "interfaces/values.hpp"

namespace node {

/// Appends the reference of one actuator to a command; its unit follows from the mode: V, m, A or N.
inline void append_reference(erp::ActuatorCommand& command, const std::string& actuator,
                             erp::Mode mode, double reference) {
  erp::ActuatorReference added{};
  erp::assign(added.name, actuator);
  added.mode = static_cast<std::uint8_t>(mode);
  added.reference = reference;
  erp::append(command.actuators, added);
}

/// Calls `write(file)`. Reports an exception as a fault event instead of throwing it.
void write_or_report(Node& node, const std::string& file, auto write) {
  try {
    write(file);
  } catch (const std::exception& e) {
    node.report(erp::Severity::fault, file, "not_written", e.what());
  }
}

}  // namespace node
