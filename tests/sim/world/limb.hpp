#pragma once
#include <cmath>
#include <vector>

#include "sim/control/gain_design.hpp"
#include "sim/world/virtual_ecus.hpp"

/// A simulated robot that is commanded like by the plant: parameters, arming, set-points every
/// tick.
class Limb {
 public:
  explicit Limb(const erp::Robot& robot, const sim::WorldOptions& world_options = {},
                const sim::VirtualEcuOptions& ecu_options = {})
      : robot_(robot), world(robot, world_options), ecus(robot, ecu_options) {
    for (const erp::Actuator& actuator : robot_.actuators) {
      const auto gains = sim::design_parameters(robot_, actuator, {});
      erp::EcuParameter message;
      for (std::size_t k = 0; k < gains.size(); ++k)
        erp::append(message.values, erp::EcuParameterValue{
                                        std::uint8_t(actuator.ecu), std::uint8_t(actuator.channel),
                                        std::uint8_t(k), k + 1 == gains.size(), gains[k]});
      ecus.receive(message);
    }
    command(ECU_REQUEST_ARM, std::vector<double>(robot_.actuators.size(), 0.0));
  }

  /// Set-points in the unit of the request.
  void command(ecu_request request, const std::vector<double>& setpoints) {
    erp::EcuCommand message;
    for (std::size_t k = 0; k < setpoints.size(); ++k) {
      const erp::Actuator& actuator = robot_.actuators[k];
      erp::append(
          message.channels,
          erp::EcuChannelCommand{std::uint8_t(actuator.ecu), std::uint8_t(actuator.channel),
                                 std::uint8_t(request), std::int32_t(std::lround(setpoints[k]))});
    }
    ecus.receive(message);
  }

  /// One tick of length control; lines as change since the start.
  void follow_lines(const std::vector<double>& line_m) {
    std::vector<double> counts(line_m.size());
    for (std::size_t k = 0; k < counts.size(); ++k) {
      const erp::Actuator& actuator = robot_.actuators[k];
      const sim::SensorScale scale(robot_.motor_of(actuator), robot_.sensors_of(actuator));
      counts[k] = -line_m[k] / actuator.spindle.radius_m / scale.shaft_rad_per_count;
    }
    command(ECU_REQUEST_LENGTH, counts);
    ecus.tick(world);
  }

  bool all_running() {
    for (const ecu_channel* channel : ecus.channels())
      if (channel->state != ECU_STATE_RUNNING) return false;
    return true;
  }

 private:
  erp::Robot robot_;

 public:
  sim::World world;
  sim::VirtualEcus ecus;
};
