#include "sim/model/actuator/motor.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/sim/rigs.hpp"

using rigs::caliper, rigs::without_friction, rigs::spindle_radius_m;
using sim::Motor, sim::MotorState;

namespace {

/// eq. 3 as in the paper, for a motor that drives the load (ω > 0), integrated by Runge–Kutta.
MotorState runge_kutta(const erp::MotorType& m, MotorState x, double v, double f, double t) {
  const double n = m.gear_ratio, eta = m.gear_efficiency;
  const double j = m.rotor_inertia_kg_m2 * n * n * eta + m.gear_inertia_kg_m2;
  const double friction = n * eta * m.rotor_coulomb_Nm + m.gear_coulomb_Nm;
  const auto rate = [&](const MotorState& s) -> MotorState {
    const double i = s.current_A, w = s.speed_rad_per_s;
    const double torque =
        m.torque_Nm_per_A * n * eta * i -
        (m.rotor_viscous_Nm_s_per_rad * n * n * eta + m.gear_viscous_Nm_s_per_rad) * w -
        spindle_radius_m * f - friction;
    return {(v - m.resistance_ohm * i - m.back_emf_V_s_per_rad * n * w) / m.inductance_H,
            torque / j, w};
  };
  const auto plus = [](MotorState a, const MotorState& b, double h) {
    return MotorState{a.current_A + h * b.current_A, a.speed_rad_per_s + h * b.speed_rad_per_s,
                      a.shaft_rad + h * b.shaft_rad};
  };
  const int steps = 20000;
  const double h = t / steps;
  for (int k = 0; k < steps; ++k) {
    const auto k1 = rate(x), k2 = rate(plus(x, k1, h / 2)), k3 = rate(plus(x, k2, h / 2)),
               k4 = rate(plus(x, k3, h));
    x = plus(plus(plus(plus(x, k1, h / 6), k2, h / 3), k3, h / 3), k4, h / 6);
  }
  return x;
}

void check_equal(const MotorState& a, const MotorState& b, double tolerance) {
  CHECK(std::abs(a.current_A - b.current_A) < tolerance);
  CHECK(std::abs(a.speed_rad_per_s - b.speed_rad_per_s) < tolerance);
  CHECK(std::abs(a.shaft_rad - b.shaft_rad) < tolerance);
}

MotorState in_pieces(const Motor& motor, MotorState x, double v, double f, double t, int pieces) {
  for (int k = 0; k < pieces; ++k) x = step(motor, x, v, f, t / pieces);
  return x;
}

}  // namespace

TEST_CASE("one long step of a driving motor equals the numerical integration of eq. 3") {
  const Motor motor(caliper(), spindle_radius_m);
  const MotorState start{0.5, 1.0, 0.3};
  check_equal(step(motor, start, 9.0, 40.0, 0.02), runge_kutta(caliper(), start, 9.0, 40.0, 0.02),
              1e-10);
}

TEST_CASE(
    "one long step of an oscillating motor with a large inductance equals the numerical "
    "integration") {
  erp::MotorType slow = caliper();
  slow.inductance_H = 0.05;
  const Motor motor(slow, spindle_radius_m);
  const MotorState start{0.5, 1.0, 0.3};
  check_equal(step(motor, start, 9.0, 40.0, 0.02), runge_kutta(slow, start, 9.0, 40.0, 0.02),
              1e-10);
}

TEST_CASE("the unloaded motor turns at the published speed and holds the published load") {
  const Motor motor(without_friction(caliper()), spindle_radius_m);
  const double v_per_k = 12.0 / (11.5e-3 * 128);
  CHECK(step(motor, {}, 12.0, 0.0, 1.0).speed_rad_per_s == Approx(v_per_k).epsilon(1e-12));
  CHECK(v_per_k == Approx(8.15).epsilon(1e-3));
  const double holding_A = spindle_radius_m * 40 / (0.59 * 128 * 11.5e-3);
  CHECK(holding_A == Approx(0.207).epsilon(2e-3));
  const MotorState loaded = step(motor, {}, 0.516 * holding_A, 40.0, 1.0);
  CHECK(loaded.speed_rad_per_s == Approx(0).margin(1e-9));
}

TEST_CASE("the steady speed under friction and load is the root of eq. 3") {
  const erp::MotorType m = caliper();
  const Motor motor(m, spindle_radius_m);
  // 0 = e N (K_T i − µ_M N ω − τ_CM) − µ_G ω − τ_CG − r F,  0 = V − R i − K_E N ω
  const double v = 6, f = 80, n = 128, eta = 0.59, k = 11.5e-3;
  const double drive = eta * n * (k * v / m.resistance_ohm - 0.3e-3) - 5e-3 - spindle_radius_m * f;
  const double drag = eta * n * n * (k * k / m.resistance_ohm + 1e-6) + 5e-4;
  CHECK(step(motor, {}, v, f, 2.0).speed_rad_per_s == Approx(drive / drag).epsilon(1e-12));
}

TEST_CASE("with a sticking shaft the current is i = V/R (1 − e^(−Rt/L))") {
  const Motor motor(caliper(), spindle_radius_m);
  const double v = 0.516 * 0.02, t = 5e-5;  // 0.02 A is inside the friction band
  const MotorState x = step(motor, {}, v, 0.0, t);
  CHECK(x.current_A == Approx(0.02 * -std::expm1(-0.516 / 57.3e-6 * t)).epsilon(1e-12));
  CHECK(x.speed_rad_per_s == 0.0);
  CHECK(x.shaft_rad == 0.0);
}

TEST_CASE("the shaft sticks below the friction torque and turns above it, in both directions") {
  const Motor motor(caliper(), spindle_radius_m);
  const double n = 128, eta = 0.59, k = 11.5e-3, f = 30, r = spindle_radius_m;
  const double up_A = ((r * f + 5e-3) / (eta * n) + 0.3e-3) / k;
  const double down_A = (eta * (r * f - 5e-3) / n - 0.3e-3) / k;  // back-driven: 1/η
  const auto speed = [&](double current_A) {
    return step(motor, {current_A, 0, 0}, 0.516 * current_A, f, 0.01).speed_rad_per_s;
  };
  CHECK(speed(up_A * 0.9999) == 0.0);
  CHECK(speed(up_A * 1.0001) > 0.0);
  CHECK(speed(down_A * 1.0001) == 0.0);
  CHECK(speed(down_A * 0.9999) < 0.0);
}

TEST_CASE("without current the shaft holds a load until the load back-drives the gear") {
  const Motor motor(caliper(), spindle_radius_m);
  const double holds_N = (5e-3 + 128 * 0.3e-3 / 0.59) / spindle_radius_m;
  CHECK(step(motor, {}, 0.0, holds_N * 0.999, 0.1).speed_rad_per_s == 0.0);
  CHECK(step(motor, {}, 0.0, holds_N * 1.001, 0.1).speed_rad_per_s < 0.0);
}

TEST_CASE("a shaft at rest breaks away when the motor torque reaches the friction torque") {
  const Motor motor(caliper(), spindle_radius_m);
  const double up_A = (5e-3 / (0.59 * 128) + 0.3e-3) / 11.5e-3, end_A = 12 / 0.516;
  const double t = -57.3e-6 / 0.516 * std::log(1 - up_A / end_A);
  CHECK(step(motor, {}, 12.0, 0.0, t * (1 - 1e-9)).speed_rad_per_s == 0.0);
  CHECK(step(motor, {}, 12.0, 0.0, t * 1.01).speed_rad_per_s > 0.0);
  CHECK(step(motor, {}, 12.0, 0.0, t).current_A == Approx(up_A).epsilon(1e-9));
}

TEST_CASE("subdivision of a step does not change stops, breakaways and reversals") {
  const Motor motor(caliper(), spindle_radius_m);
  struct Case {
    MotorState start;
    double v, f;
  };
  const std::vector<Case> cases{
      {{0, 2, 0}, -6, 20},      // brakes, stops, reverses, is back-driven
      {{0, -3, 0}, 5, 60},      // unwinds, stops, winds up
      {{0, 1, 0}, 0, 5},        // coasts and sticks
      {{-20, 0.01, 0}, 12, 0},  // an electric transient reverses it twice within a step
      {{0, 0, 0}, 3, 30},       // breaks away
      {{0, -1, 0}, 0, 1.2},     // the mesh torque changes sign during the step
      {{0, 4, 0}, -1, 0},
  };
  for (const Case& c : cases) {
    CAPTURE(c.v, c.f, c.start.speed_rad_per_s);
    const MotorState one_step = step(motor, c.start, c.v, c.f, 0.05);
    check_equal(one_step, in_pieces(motor, c.start, c.v, c.f, 0.05, 50), 1e-11);
    check_equal(one_step, in_pieces(motor, c.start, c.v, c.f, 0.05, 4999), 1e-9);
  }
}

TEST_CASE("a coasting shaft comes to an exact standstill and stays at rest") {
  const Motor motor(caliper(), spindle_radius_m);
  MotorState x = in_pieces(motor, {0, 5, 0}, 0.0, 10.0, 0.2, 200);
  CHECK(x.speed_rad_per_s == 0.0);
  const double shaft = x.shaft_rad;
  x = in_pieces(motor, x, 0.0, 10.0, 10.0, 10000);
  CHECK(x.shaft_rad == shaft);
}

TEST_CASE("a motor with unstable equations is rejected") {
  erp::MotorType m = caliper();
  m.resistance_ohm = -1;
  CHECK_THROWS_AS(Motor(m, spindle_radius_m), std::invalid_argument);
  CHECK_THROWS_AS(Motor(caliper(), 0.0), std::invalid_argument);
}

TEST_CASE("a torque on the rotor is balanced by the current τ/K_T at any gear efficiency") {
  const erp::MotorType type = caliper();
  const Motor motor(type, spindle_radius_m);
  const double rotor_Nm = 1e-3, current_A = rotor_Nm / type.torque_Nm_per_A;
  const auto edge_A = [&](double torque_Nm, int direction) {
    double low = -5, high = 5;  // bracket of the current at which it starts to turn
    for (int n = 0; n < 60; ++n) {
      const double middle = (low + high) / 2;
      const int sign = motor.breakaway(middle, {.tension_N = 20, .rotor_Nm = torque_Nm});
      (direction > 0 ? sign > 0 : sign >= 0) ? high = middle : low = middle;
    }
    return low;
  };
  for (const int direction : {1, -1})
    CHECK(edge_A(rotor_Nm, direction) - edge_A(0, direction) == Approx(current_A));
  const MotorState turning{edge_A(0, 1) + 1, 2, 0};
  const auto after_s = [&](double extra_A, double torque_Nm) {
    const double volts = type.resistance_ohm * (turning.current_A + extra_A) +
                         type.back_emf_V_s_per_rad * type.gear_ratio * 2;
    return step(motor, {turning.current_A + extra_A, 2, 0}, volts,
                {.tension_N = 20, .rotor_Nm = torque_Nm}, 0.002)
        .speed_rad_per_s;
  };
  CHECK(after_s(current_A, rotor_Nm) == Approx(after_s(0, 0)));
  CHECK(after_s(0, rotor_Nm) < after_s(0, 0));
}
