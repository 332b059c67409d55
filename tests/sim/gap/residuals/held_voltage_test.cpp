#include "sim/gap/residuals/held_voltage.hpp"

#include <catch2/catch.hpp>

using namespace sim::residuals;

namespace {

constexpr double period_s = 0.002;

erp::MotorType motor(double inductance_H) {
  erp::MotorType m{};
  m.resistance_ohm = 0.516, m.inductance_H = inductance_H;
  m.back_emf_V_s_per_rad = m.torque_Nm_per_A = 11.5e-3;
  m.gear_ratio = 128, m.gear_efficiency = 0.59;
  m.rotor_inertia_kg_m2 = 14.5e-7, m.gear_inertia_kg_m2 = 0.4e-7;
  return m;
}

/// Samples at three rows.
struct Samples {
  double current_A[3], angle_rad[3];
};

/// Simulates the motor from 1.3 A and 2 rad/s in steps of 20 ns (midpoint rule). The first of three
/// voltages is the previous one, which acts during the delay of the driver.
Samples run(const erp::MotorType& m, const double (&voltages)[3], double load_Nm, double delay_s) {
  const double n = m.gear_ratio, inertia = shaft_inertia_kg_m2(m), dt = 2e-8;
  double i = 1.3, w = 2, angle = 0;
  const auto rates = [&](double v, double amps, double speed) {
    return std::pair{
        (v - m.resistance_ohm * amps - m.back_emf_V_s_per_rad * n * speed) / m.inductance_H,
        (m.torque_Nm_per_A * n * amps - load_Nm) / inertia};
  };
  Samples samples{{i}, {angle}};
  for (int k = 0; k < 2; ++k) {
    for (int s = 0; s < int(period_s / dt + 0.5); ++s) {
      const double volts = voltages[s < int(delay_s / dt + 0.5) ? k : k + 1];
      const auto [di, dw] = rates(volts, i, w);
      const auto [mi, mw] = rates(volts, i + dt / 2 * di, w + dt / 2 * dw);
      angle += dt * (w + dt / 2 * dw), i += dt * mi, w += dt * mw;
    }
    samples.current_A[k + 1] = i, samples.angle_rad[k + 1] = angle;
  }
  return samples;
}

}  // namespace

TEST_CASE(
    "currents and voltages determine the travel of the shaft exactly, currents and travel "
    "determine "
    "the load exactly") {
  const double inductance_H = GENERATE(57.3e-7, 57.3e-6, 722e-6, 1.8e-3), load_Nm = 2.7;
  const double delay_s = GENERATE(0.0, 3e-4, 1.5e-3);
  CAPTURE(inductance_H, delay_s);
  const auto m = motor(inductance_H);
  const double volts[] = {1.2, 4.1, -2.6};
  const Samples s = run(m, volts, load_Nm, delay_s);
  const TwoPeriods two = two_periods(m, period_s, delay_s);
  double emf_V = 0, current_A = two.drives_per_V * volts[0];
  for (int k = 0; k < 3; ++k) {
    emf_V += two.volts[k] * volts[k];
    emf_V -= m.resistance_ohm * two.amperes[k] * s.current_A[k];
    current_A += two.drives[k] * s.current_A[k];
  }
  const double rad_per_s = (s.angle_rad[2] - s.angle_rad[0]) / (2 * period_s);
  current_A += two.drives_per_speed * rad_per_s;
  const double second_difference = (s.angle_rad[2] - 2 * s.angle_rad[1]) / (period_s * period_s);
  CHECK(emf_V == Approx(m.back_emf_V_s_per_rad * m.gear_ratio * rad_per_s).epsilon(1e-5));
  CHECK(m.torque_Nm_per_A * m.gear_ratio * current_A - two.inertia_kg_m2 * second_difference ==
        Approx(load_Nm).epsilon(1e-5));
}

TEST_CASE("the weights of each quantity sum to one") {
  const double inductance_H = GENERATE(1e-6, 57.3e-6, 1.8e-3);
  const auto two = two_periods(motor(inductance_H), period_s);
  CHECK(two.volts[0] == 0);
  CHECK(two.volts[1] + two.volts[2] == Approx(1));
  CHECK(two.drives_per_V == 0);
  CHECK(two.drives_per_speed == Approx(0).margin(1e-9));
  CHECK(two.amperes[0] + two.amperes[1] + two.amperes[2] == Approx(1));
  CHECK(two.drives[0] + two.drives[1] + two.drives[2] == Approx(1));
}

TEST_CASE("a winding of 1 H gives the weights of a triangular window") {
  const auto two = two_periods(motor(1), period_s);  // current linear between samples
  CHECK(two.drives[0] == Approx(1. / 6).epsilon(0.01));
  CHECK(two.drives[1] == Approx(4. / 6).epsilon(0.01));
  CHECK(two.inertia_kg_m2 == Approx(shaft_inertia_kg_m2(motor(1))).epsilon(0.01));
}

TEST_CASE("a force control averages the force of two periods with equal weights") {
  erp::MotorType force{};  // of a drive with force control
  force.resistance_ohm = 1, force.inductance_H = 1e-6, force.torque_Nm_per_A = 3;
  force.gear_ratio = force.gear_efficiency = 1, force.rotor_inertia_kg_m2 = 90;
  const auto two = two_periods(force, period_s);
  CHECK(two.inertia_kg_m2 == Approx(90));
  CHECK(two.drives[1] == Approx(0.5).epsilon(2e-3));
  CHECK(two.drives[2] == Approx(0.5).epsilon(2e-3));
}

TEST_CASE("a warm winding has the weights of its resistance") {
  auto warm = motor(722e-6);
  TwoPeriodsAt two(warm, period_s);
  CHECK(two.at(0.516).volts == two_periods(warm, period_s).volts);
  warm.resistance_ohm = 0.6;
  CHECK(two.at(0.6).volts == two_periods(warm, period_s).volts);
}
