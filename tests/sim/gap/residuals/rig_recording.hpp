#pragma once
#include <cmath>
#include <numbers>

#include "interfaces/recording/columns.hpp"
#include "sim/gap/residuals/episode.hpp"
#include "tests/sim/world/limb.hpp"

/// Simulated recordings of hinge_rig with sinusoidal tensions.
namespace rig_recording {

/// Tensions of flexor and extensor: mean ± (swing sin + ripple sin).
struct Plan {
  double seconds = 10;
  double swing_N = 18, swing_Hz = 0.4, ripple_N = 4, ripple_Hz = 1.7, mean_N = 14;
  std::uint64_t seed = 1;
};

inline recording::Table table_of_run(const erp::Robot& robot, const Plan& plan) {
  Limb limb(robot, {}, {.seed = plan.seed});
  recording::Table table;
  table.columns.push_back({"time_s", {}});
  for (std::string& name : recording::columns_of(robot))
    table.columns.push_back({std::move(name), {}});
  erp::EcuFrame frame;
  const double full_turn_rad = 2 * std::numbers::pi;
  for (int k = 0; k < static_cast<int>(plan.seconds * 500); ++k) {
    const double t = 0.002 * k;
    const double swing = plan.swing_N * std::sin(full_turn_rad * plan.swing_Hz * t) +
                         plan.ripple_N * std::sin(full_turn_rad * plan.ripple_Hz * t);
    const double desired[] = {std::fmax(1.0, plan.mean_N + swing),
                              std::fmax(1.0, plan.mean_N - swing)};
    limb.command(ECU_REQUEST_FORCE, {1000 * desired[0], 1000 * desired[1]});
    limb.ecus.tick(limb.world);
    limb.ecus.fill(frame);
    std::size_t column = 0;
    const auto append = [&](double value) { table.columns[column++].values.push_back(value); };
    append(t);
    for (std::size_t a = 0; a < 2; ++a) {
      const auto& channel = frame.channels._buffer[a];
      const erp::MotorType& motor = robot.motor_of(robot.actuators[a]);
      const sim::SensorScale scale(motor, robot.sensors_of(robot.actuators[a]));
      append(double(erp::Mode::force)), append(desired[a]);
      append(motor.supply_V * channel.duty_counts / ECU_DUTY_MAX);
      append(channel.current_counts * scale.current_A_per_count);
      append(channel.encoder_counts * scale.shaft_rad_per_count);
      append(channel.tension_counts * scale.tension_N_per_count);
    }
    append(frame.analogs._buffer[0].counts * full_turn_rad / (1 << 14));
  }
  return table;
}

inline sim::residuals::Episode record(const erp::Robot& nominal, const erp::Robot& real,
                                      const Plan& plan) {
  std::vector<std::string> remarks;
  return sim::residuals::lay_out(table_of_run(real, plan), nominal, "run", remarks);
}

}  // namespace rig_recording
