#include "sim/gap/residuals/column.hpp"

#include "sim/gap/residuals/drives.hpp"

namespace sim::residuals {
namespace {

std::string name_of_drive_column(const erp::Drive& drive, Quantity quantity, bool current_is_set) {
  const auto names = drive_columns(drive);
  switch (quantity) {
    case Quantity::voltage:
      return names.control_V;
    case Quantity::current:
      return current_is_set ? names.control_V : names.current_A;
    case Quantity::shaft:
      return names.position;
    case Quantity::tension:
      return names.torque;
    case Quantity::angle:
      break;
  }
  return drive.find<erp::LoadEncoder>() ? names.load : names.position;
}

}  // namespace

std::vector<Column> all_columns(std::size_t actuators, std::size_t joints) {
  std::vector<Column> columns;
  for (std::size_t a = 0; a < actuators; ++a)
    for (const Quantity quantity : actuator_quantities) columns.push_back({quantity, a});
  for (std::size_t j = 0; j < joints; ++j) columns.push_back({Quantity::angle, j});
  return columns;
}

std::string name_of(const Column& column, const Episode& episode, const erp::Robot& robot) {
  if (column.quantity == Quantity::angle) {
    const erp::Joint joint = robot.joints()[column.of];
    const erp::Drive* drive = drive_of(robot, joint.name);
    if (drive) return name_of_drive_column(*drive, Quantity::angle, false);
    return joint.name + (joint.type == erp::JointType::spherical ? ".qw … qz" : ".angle_rad");
  }
  const std::string& actuator = robot.actuators[column.of].name;
  if (const erp::Drive* drive = drive_of(robot, actuator))
    return name_of_drive_column(*drive, column.quantity,
                                episode.actuators[column.of].current_around);
  constexpr std::array endings{".voltage_V", ".current_A", ".shaft_rad", ".tension_N"};
  return actuator + endings[static_cast<std::size_t>(column.quantity)];
}

}  // namespace sim::residuals
