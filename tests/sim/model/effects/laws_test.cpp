#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/model/effects/acting.hpp"
#include "sim/model/effects/all.hpp"
#include "sim/model/effects/library.hpp"

using namespace sim::effects;

namespace {

ChainSample at(double shaft_rad, double tension_N = 0) {
  ChainSample s;
  s.dt_s = 0.001, s.radius_m = 0.005, s.shaft_rad = shaft_rad, s.tension_N = tension_N;
  s.load_Nm = s.radius_m * tension_N;
  return s;
}

Sloped nominal_line(const ChainSample& s) { return {s.radius_m * s.shaft_rad, s.radius_m}; }

}  // namespace

TEST_CASE(
    "the spindle crosses the backlash while the line is slack, and a load holds it on the flank") {
  GearboxBacklash play;
  play.width_rad = 0.1, play.spindle_friction_Nm = 0.003;
  Memory memory{};
  constexpr double slack_m = -1, stiffness = 6000;
  const auto stretched = [&](double shaft_rad, double nominal_m) {
    ChainSample s = at(shaft_rad, 0);
    s.stretch_m = nominal_m, s.stiffness_N_per_m = stiffness;
    return play.wound(s, nominal_line(s), memory).value;
  };
  const auto wound = [&](double shaft_rad, double tension_N) {
    return stretched(shaft_rad, tension_N > 0 ? tension_N / stiffness : slack_m);
  };
  CHECK(wound(1.0, 20) == Approx(0.005 * 1.0));    // on the flank
  CHECK(wound(0.96, 0) == Approx(0.005 * 1.0));    // the spindle stays
  CHECK(wound(0.8, 0) == Approx(0.005 * 0.9));     // moved by the other flank
  CHECK(wound(0.85, 0) == Approx(0.005 * 0.9));    // back across the backlash
  CHECK(wound(0.95, 0) == Approx(0.005 * 0.95));   // and wound up again
  CHECK(wound(0.93, 20) == Approx(0.005 * 0.93));  // a load holds it on the flank
  // across the backlash the line would pull 1.8 N: the spindle turns until its friction holds 0.6 N
  CHECK(wound(0.83, 0) == Approx(0.005 * 0.93));
  CHECK(stretched(0.83, -2e-4) == Approx(0.005 * 0.83 + 3e-4));
}

TEST_CASE("with layers the wound length is the integral of the radius") {
  SpindleLayers layers;
  layers.growth_m_per_rad = 1e-4;
  Memory memory{};
  double sum = 0;
  for (int k = 0; k < 1000; ++k) sum += 0.01 * (0.005 + 1e-4 * (0.01 * k + 0.005));
  const ChainSample s = at(10);
  const Sloped line = layers.wound(s, nominal_line(s), memory);
  CHECK(line.value == Approx(sum));
  CHECK(line.slope == Approx(0.006));
  layers.growth_m_per_rad = -1e-3;  // the radius is limited to a fifth
  CHECK(layers.wound(s, nominal_line(s), memory).slope == Approx(0.001));
}

TEST_CASE(
    "slip is proportional to load and distance in both directions, independent of the start") {
  SpindleSlip slip;
  slip.per_N = 1e-4;
  Memory memory{};
  double slipped_m = 0;
  for (const double shaft : {2.0, 3.0, 2.0, 3.0}) {
    const ChainSample s = at(shaft, 50);
    slipped_m = nominal_line(s).value - slip.wound(s, nominal_line(s), memory).value;
  }
  CHECK(slipped_m == Approx(3 * 0.005 * 50 * 1e-4));
}

TEST_CASE("creep decays by 1/e in its time constant") {
  TendonCreep creep{1000, 2};
  Memory memory{};
  ChainSample s = at(0);
  creep.pull(s, memory);
  s.stretch_m = 0.01;
  Sloped pull = creep.pull(s, memory);
  CHECK(pull.value == Approx(10).epsilon(1e-3));
  for (int k = 1; k < 2000; ++k) pull = creep.pull(s, memory);
  CHECK(pull.value == Approx(10 / std::exp(1.0)).epsilon(1e-6));
}

TEST_CASE(
    "after slack, creep and hysteresis continue from zero stretch for a line, but not for a "
    "shaft") {
  const auto pull_N = [](auto law, double compressed_m, bool pushes) {
    Memory memory{};
    ChainSample s = at(0);
    s.pushes = pushes, s.stretch_m = 0.002;
    law.pull(s, memory);
    for (int k = 0; k < 500; ++k) s.stretch_m = -compressed_m, law.pull(s, memory);
    s.stretch_m = 0.0003;
    return law.pull(s, memory).value;
  };
  const auto check = [&](auto law) {
    CHECK(pull_N(law, 0.02, false) == pull_N(law, 0, false));
    CHECK(pull_N(law, 0.02, true) > pull_N(law, 0, true) + 0.1);
  };
  check(TendonCreep{1000, 2});
  check(TendonHysteresis{3, 5e-4});
}

TEST_CASE(
    "a closed loop of stretch with hysteresis dissipates energy, independent of the step size") {
  const auto loop_J = [](int steps) {
    TendonHysteresis braid{3, 5e-4};
    Memory memory{};
    double work = 0, last_m = 0;
    ChainSample s = at(0);
    braid.pull(s, memory);
    for (int k = 1; k <= 3 * steps; ++k) {
      s.stretch_m = 0.003 * (1 - std::cos(2 * M_PI * k / steps));
      const double force = braid.pull(s, memory).value;
      if (k > 2 * steps) work += force * (s.stretch_m - last_m);
      last_m = s.stretch_m;
    }
    return work;
  };
  const double fine_J = loop_J(20000);
  CHECK(fine_J > 0.9 * 2 * 3 * 0.006 * 0.8);  // close to ± F_h on both branches of the loop
  CHECK(fine_J < 2 * 3 * 0.006);
  CHECK(loop_J(500) == Approx(fine_J).epsilon(0.05));
}

TEST_CASE(
    "capstan friction gives Euler's ratio, with the larger tension at the end towards which the "
    "line moves") {
  RoutingCapstan capstan;
  capstan.friction = 0.2;
  ChainSample s = at(0, 10);
  s.wrap_rad = 2, s.line_speed_m_per_s = 0.1;
  CHECK(capstan.motor_side_N(10, s) == Approx(10 * std::exp(0.4)));
  s.line_speed_m_per_s = -0.1;
  CHECK(capstan.motor_side_N(10, s) == Approx(10 * std::exp(-0.4)));
  capstan.post = 0.1;  // independent of the bend
  CHECK(capstan.motor_side_N(10, s) == Approx(10 * std::exp(-0.5)));
  s.wrap_rad = 0;
  CHECK(capstan.motor_side_N(10, s) == Approx(10 * std::exp(-0.1)));
}

TEST_CASE("the compliance of the kite line decreases with the wound length") {
  constexpr double spring = 6000, c = 1e-4, stretch_m = 0.005, start_m = 0.3;
  const TendonKiteLine line{c};
  Memory memory{};
  for (const double length_m : {0.2, 0.3, 0.4}) {
    ChainSample s;
    s.path_m = length_m, s.path_change_m = length_m - start_m, s.stretch_m = stretch_m;
    const double at_start = 1 / (1 / spring + c);  // the softer spring of change_actuator
    s.stiffness_N_per_m = at_start;
    const double unstretched_m = length_m - stretch_m;
    const double exact_N = stretch_m / (1 / spring + c * unstretched_m / start_m);
    CHECK(at_start * stretch_m + line.pull(s, memory).value == Approx(exact_N));
  }
}

TEST_CASE("thermal resistance reaches the steady-state rise with the time constant") {
  MotorThermalResistance winding{10, 5};
  Memory memory{};
  ChainSample s = at(0);
  s.current_A = 2, s.current_square_A2 = 4;
  double ohm = 0;
  for (int k = 0; k < 100000; ++k) ohm = winding.resistance_ohm(0.5, s, memory);
  const double rise_K = 10 * ohm * 4;  // R_th i² R
  CHECK(ohm == Approx(0.5 * (1 + 0.00393 * rise_K)));
}

TEST_CASE("a dead band reduces the voltage by V₀, and supply sag adds resistance") {
  const MotorDeadBand band{0.5};
  ChainSample s = at(0);
  Memory memory{};
  CHECK(band.voltage_V(3, s) == Approx(2.5));
  CHECK(band.voltage_V(-3, s) == Approx(-2.5));
  CHECK(band.voltage_V(0.3, s) == 0);
  const SupplySag sag{0.5};
  s.supply_V = 12, s.voltage_V = 6;
  CHECK(sag.resistance_ohm(0.4, s, memory) == Approx(0.4 + 0.25 * 0.5));
}

/// Voltages that a delayed driver applies, one per step of 1 ms.
std::vector<double> applied_V(double delay_s, const std::vector<double>& commanded_V) {
  const MotorDriverDelay driver{delay_s};
  Memory memory{};
  std::vector<double> all;
  for (const double v : commanded_V) all.push_back(driver.delayed_voltage_V(v, at(0), memory));
  return all;
}

TEST_CASE(
    "a driver delay shifts the voltage by whole steps and averages over the fraction of a step") {
  const std::vector<double> commanded_V{1, 1, 5, 5, 2, 2, 2, 7};
  CHECK(applied_V(0, commanded_V) == commanded_V);
  CHECK(applied_V(0.001, commanded_V) == std::vector<double>{1, 1, 1, 5, 5, 2, 2, 2});
  const auto delayed = applied_V(0.00125, commanded_V);
  CHECK(delayed[3] == Approx(0.25 * 1 + 0.75 * 5));
  CHECK(delayed[5] == Approx(0.25 * 5 + 0.75 * 2));
  CHECK(delayed[7] == Approx(2));
}

TEST_CASE("with three pending voltage changes, a fourth change applies the oldest") {
  const auto delayed = applied_V(1, {1, 2, 3, 4, 5});
  CHECK(delayed == std::vector<double>{1, 1, 1, 1, 2});
}

TEST_CASE("stiction grows to its extra friction at rest and decreases over the slip distance") {
  const GearboxAgeingStiction stiction{0.2, 2, 0.1};
  Memory memory{};
  ChainSample s = at(0);
  s.dt_s = 2;
  CHECK(stiction.aged_Nm(s, memory) == Approx(0.2 * (1 - std::exp(-1))));
  s.dt_s = 100;
  CHECK(stiction.aged_Nm(s, memory) == Approx(0.2));
  s.dt_s = 0.01, s.speed_rad_per_s = -10;  // 0.1 rad
  CHECK(stiction.aged_Nm(s, memory) == Approx(0.2 * std::exp(-1)).epsilon(0.02));
}

TEST_CASE("position-dependent friction repeats periods_per_turn times per turn") {
  const GearboxPositionDependent friction{0.03, 0.04, 3};
  ChainSample s = at(0);
  CHECK(friction.friction_Nm(1, s) == Approx(0.04));
  s.shaft_rad = std::numbers::pi / 6;
  CHECK(friction.friction_Nm(-1, s) == Approx(0.03));
  s.shaft_rad += 2 * std::numbers::pi / 3;
  CHECK(friction.friction_Nm(1, s) == Approx(0.03));
}

TEST_CASE("with joint play the sensor's shaft follows at the edges of the play") {
  const JointPlay play{0.02};
  Memory memory{};
  CHECK(play.sensor_shaft_rad(0.005, memory) == 0);
  CHECK(play.sensor_shaft_rad(0.05, memory) == Approx(0.04));
  CHECK(play.sensor_shaft_rad(0.035, memory) == Approx(0.04));
  CHECK(play.sensor_shaft_rad(0.0, memory) == Approx(0.01));
}

TEST_CASE("cogging is averaged over the rotation in a step") {
  const MotorCogging teeth{1e-3, 0};
  ChainSample s;
  s.gear_ratio = 100, s.dt_s = 0.002, s.shaft_rad = 0.0013;
  const double at_rest_Nm = teeth.rotor_Nm(s);
  CHECK(at_rest_Nm == Approx(1e-3 * std::sin(1200 * 0.0013)));
  s.speed_rad_per_s = 2.617993878;  // 1200 · ω · dt = 2π: one full period
  CHECK(std::abs(teeth.rotor_Nm(s)) < 1e-9);
}
