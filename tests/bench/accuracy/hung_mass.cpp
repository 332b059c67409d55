#include <cmath>
#include <numbers>

#include "sim/world/world.hpp"
#include "tests/bench/accuracy/figure.hpp"
#include "tests/bench/accuracy/period.hpp"
#include "tests/sim/skeletons.hpp"

namespace accuracy {
namespace {

using sim::World;

// Chosen: 0.4 kg; at 0 V the friction of the gearbox holds up to 15.6 N.
constexpr double mass_kg = 0.4, g = 9.81, line_m = 0.3, dt_s = 1e-4;
const double kappa = rigs::hinge_tendon().stiffness_N_per_m;
const double damping = rigs::hinge_tendon().damping_N_s_per_m;

/// A free body below a point of the base, on one tendon that is taut with zero tension.
erp::Robot hung() {
  erp::Robot robot =
      rigs::robot({rigs::root(), rigs::bone("weight", mass_kg, {}, {1e-3, 1e-3, 1e-3})},
                  {rigs::joint("float", erp::JointType::free, "base", "weight")});
  robot.motor_types = {rigs::caliper()};
  erp::Actuator line;
  line.name = "line", line.motor = robot.motor_types[0].name;
  line.spindle.radius_m = rigs::spindle_radius_m;
  line.tendon = rigs::hinge_tendon();
  line.tendon.path = {erp::Attach{{}, "base", {0, 0, line_m}}, erp::Attach{{}, "weight", {}}};
  robot.actuators = {line};
  return robot;
}

/// Δx
double stretch_m(const World& world) {
  const sim::ActuatorReading& line = world.actuators()[0];
  return line.length_m - line_m - line.line_m;
}

// at rest: κ Δx = m g
double rest_error() {
  World world(hung());
  for (int k = 0; k < 20000; ++k) world.step(std::vector{0.0}, dt_s);
  return relative(stretch_m(world), mass_kg * g / kappa);
}

// m ẍ = −κ x − D ẋ about that rest: ω_d = √(κ/m − (D/2m)²)
double swing_error() {
  World world(hung());
  const double found_s =
      mean_period_s(world, 8, dt_s, [&] { return stretch_m(world) - mass_kg * g / kappa; });
  const double decay_per_s = damping / (2 * mass_kg);
  return relative(2 * std::numbers::pi / found_s,
                  std::sqrt(kappa / mass_kg - decay_per_s * decay_per_s));
}

/// The body starts upwards at 1 m/s where the tendon is slack by 5 mm. It returns there with the same speed after
/// 0.2 s. Chosen.
double slack_tension_N() {
  World world(hung());
  world.set_joint(0, {erp::JointType::free, {1, 0, 0, 0}, {}, {0, 0, 0.005}, {0, 0, 1}});
  double worst_N = world.actuators()[0].tension_N;
  for (int k = 0; k < 2000; ++k) {
    world.step(std::vector{0.0}, dt_s);
    worst_N = larger(worst_N, std::abs(world.actuators()[0].tension_N));
  }
  return worst_N;
}

}  // namespace

Figures hung_mass() {
  return {{5, "stretch under a suspended mass at rest, relative", rest_error(), 1e-9, ""},
          {5, "angular frequency of its damped oscillation at 0.1 ms, relative", swing_error(),
           1e-3, ""},
          {5, "tension of a slack tendon", slack_tension_N(), 0, "N"}};
}

}  // namespace accuracy
