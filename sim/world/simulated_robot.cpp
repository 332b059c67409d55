#include "sim/world/simulated_robot.hpp"

#include "sim/control/gain_design.hpp"

namespace sim {

SimulatedRobot::SimulatedRobot(const erp::Robot& robot, const erp::Robot& configured,
                               std::uint64_t seed)
    : robot_(robot), world_(robot), ecus_(robot, {.seed = seed}) {
  for (const erp::Actuator& a : configured.actuators)
    units_.emplace_back(configured.motor_of(a), configured.sensors_of(a), a.spindle);
  send_gains(configured);
  send(std::vector<SetPoint>(units_.size()));
}

void SimulatedRobot::send_gains(const erp::Robot& configured) {
  for (const erp::Actuator& a : configured.actuators) {
    const auto gains = design_parameters(configured, a, {.stuck_speed_fraction = 0});
    erp::EcuParameter message;
    for (std::size_t k = 0; k < gains.size(); ++k)
      erp::append(message.values,
                  erp::EcuParameterValue{std::uint8_t(a.ecu), std::uint8_t(a.channel),
                                         std::uint8_t(k), k + 1 == gains.size(), gains[k]});
    ecus_.receive(message);
  }
}

/// A channel of mode off stays armed: no voltage, ready for the next set-point.
void SimulatedRobot::send(std::span<const SetPoint> set_points) {
  erp::EcuCommand message;
  for (std::size_t a = 0; a < set_points.size(); ++a) {
    const erp::Actuator& actuator = robot_.actuators[a];
    const auto& [mode, reference] = set_points[a];
    const bool is_off = mode == erp::Mode::off;
    erp::append(
        message.channels,
        erp::EcuChannelCommand{std::uint8_t(actuator.ecu), std::uint8_t(actuator.channel),
                               std::uint8_t(is_off ? ECU_REQUEST_ARM : EcuUnits::request(mode)),
                               is_off ? 0 : units_[a].setpoint(mode, reference)});
  }
  ecus_.receive(message);
}

void SimulatedRobot::tick(std::span<const SetPoint> set_points) {
  send(set_points);
  ecus_.tick(world_);
  ecus_.fill(frame_);
  if (!world_.is_finite()) throw NotFinite();
}

const erp::EcuChannelSample& SimulatedRobot::sample_of(std::size_t actuator) const {
  const erp::Actuator& a = robot_.actuators[actuator];
  for (const auto& channel : erp::samples(frame_.channels))
    if (channel.ecu == a.ecu && channel.channel == a.channel) return channel;
  throw std::logic_error("no ECU channel for actuator \"" + a.name + "\"");
}

}  // namespace sim
