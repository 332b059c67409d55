#pragma once
#include <cmath>
#include <random>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "interfaces/robot/robot.hpp"

/// A light current-controlled motor with stiction. Its recordings are simulated without code of the
/// product.
namespace light_drive {

struct Light {  // a light drive
  double coulomb_Nm = 3e-3, viscous_Nm_s = 3e-5;
  double load_Nm = 0;         ///< constant torque
  double disturbance_Nm = 0;  ///< standard deviation of a random torque
};

/// Properties of a recording.
struct Rows {
  double period_s = 2e-3, seconds = 8;
  double noise_rad = 0;  ///< of the position
  unsigned seed = 3;
};

constexpr double torque_Nm_per_A = 0.05, inertia_kg_m2 = 2.2e-6;

/// Description of the drive, without friction.
inline erp::Robot description() {
  erp::MotorType motor;
  motor.name = "m", motor.resistance_ohm = 1, motor.inductance_H = 1e-4;
  motor.torque_Nm_per_A = motor.back_emf_V_s_per_rad = torque_Nm_per_A;
  motor.gear_ratio = motor.gear_efficiency = 1, motor.rotor_inertia_kg_m2 = 2e-6;
  motor.supply_V = 24;
  erp::Drive drive;
  drive.name = "m", drive.control = erp::DriveControl::current, drive.gain = 1, drive.motor = "m";
  drive.load = {erp::Shaft{{}, 0.2e-6, 0}};
  erp::Robot robot;
  robot.name = "bench";
  robot.motor_types = {motor};
  robot.drives = {drive};
  return robot;
}

/// Simulates the drive with `current(t, ω)` in A, held between rows.
recording::Table simulated(const Light& light, const Rows& rows, auto current) {
  constexpr double step_s = 2e-5, correlation_s = 0.05;
  const int steps = int(std::lround(rows.period_s / step_s));
  std::mt19937_64 random(rows.seed);
  std::normal_distribution<double> noise;
  recording::Table table;
  for (const char* name : {"time_s", "m.control_V", "m.position_rad"})
    table.columns.push_back({name, {}});
  double angle = 0, speed = 0, disturbance = 0;
  for (int k = 0; k < int(rows.seconds / rows.period_s); ++k) {
    const double t = k * rows.period_s, amperes = current(t, speed);
    const double row[] = {t, amperes, angle + rows.noise_rad * noise(random)};
    for (std::size_t c = 0; c < 3; ++c) table.columns[c].values.push_back(row[c]);
    for (int s = 0; s < steps; ++s) {
      if (light.disturbance_Nm > 0)
        disturbance += -disturbance * step_s / correlation_s +
                       std::sqrt(2 * step_s / correlation_s) * noise(random);
      const double driving_Nm = torque_Nm_per_A * amperes - light.load_Nm -
                                light.disturbance_Nm * disturbance - light.viscous_Nm_s * speed;
      if (speed == 0 && std::abs(driving_Nm) <= light.coulomb_Nm) continue;
      const int sign = speed > 0 || (speed == 0 && driving_Nm > 0) ? 1 : -1;
      double next = speed + (driving_Nm - sign * light.coulomb_Nm) / inertia_kg_m2 * step_s;
      if (speed * next < 0) next = 0;
      angle += (speed + next) / 2 * step_s, speed = next;
    }
  }
  return table;
}

/// Four recordings of sums of sines.
inline std::vector<recording::Table> of_sines(const Light& light, Rows rows = {}) {
  std::vector<recording::Table> tables;
  for (int n = 0; n < 4; ++n, ++rows.seed)
    tables.push_back(simulated(light, rows, [&](double t, double) {
      double sum = 0;
      for (int h = 1; h < 9; ++h) sum += std::sin(6.283 * (0.2 + 0.19 * h * h) * t + n * h + h * h);
      return 0.06 * sum;
    }));
  return tables;
}

/// Six recordings with one steady speed each, with a speed controller.
inline std::vector<recording::Table> at_steady_speeds(const Light& light, Rows rows = {}) {
  std::vector<recording::Table> tables;
  for (const double desired : {5.0, -10.0, 20.0, -40.0, 80.0, -160.0}) {
    double sum = 0;
    tables.push_back(simulated(light, rows, [&](double, double speed) {
      sum += (desired - speed) * rows.period_s;
      return 2e-4 * (desired - speed) + 4e-3 * sum + std::copysign(0.06, desired);
    }));
    ++rows.seed;
  }
  return tables;
}

}  // namespace light_drive
