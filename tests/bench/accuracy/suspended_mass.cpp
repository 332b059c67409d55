#include <cmath>
#include <numbers>

#include "sim/world/world.hpp"
#include "tests/bench/accuracy/figure.hpp"
#include "tests/bench/accuracy/period.hpp"
#include "tests/sim/skeletons.hpp"

namespace accuracy {
namespace {

using sim::World;

// Chosen: the weight of 0.4 kg does not turn the motor. At 0 V the gearbox friction resists forces
// up to 15.6 N.
constexpr double mass_kg = 0.4, g = 9.81, line_m = 0.3, dt_s = 1e-4;
const double kappa = rigs::hinge_tendon().stiffness_N_per_m;
const double damping = rigs::hinge_tendon().damping_N_s_per_m;

/// A free body below a point of the base, on one tendon that is taut with zero tension.
erp::Robot suspended_robot() {
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

/// Δx, the elongation of the tendon.
double stretch_m(const World& world) {
  const sim::ActuatorReading& line = world.actuators()[0];
  return line.length_m - line_m - line.line_m;
}

// At rest: κ Δx = m g
double rest_stretch_error() {
  World world(suspended_robot());
  for (int k = 0; k < 20000; ++k) world.step(std::vector{0.0}, dt_s);
  return relative_error(stretch_m(world), mass_kg * g / kappa);
}

// About the position at rest: m ẍ = −κ x − D ẋ, ω_d = √(κ/m − (D/2m)²)
double frequency_error() {
  World world(suspended_robot());
  const double measured_period_s =
      mean_period_s(world, 8, dt_s, [&] { return stretch_m(world) - mass_kg * g / kappa; });
  const double decay_per_s = damping / (2 * mass_kg);
  return relative_error(2 * std::numbers::pi / measured_period_s,
                        std::sqrt(kappa / mass_kg - decay_per_s * decay_per_s));
}

/// The largest tension of a slack tendon. Chosen: the body starts upwards at 1 m/s where the tendon
/// is slack by 5 mm. It returns to this place with the same speed after 0.2 s.
double slack_tension_N() {
  World world(suspended_robot());
  world.set_joint(0, {erp::JointType::free, {1, 0, 0, 0}, {}, {0, 0, 0.005}, {0, 0, 1}});
  double worst_N = world.actuators()[0].tension_N;
  for (int k = 0; k < 2000; ++k) {
    world.step(std::vector{0.0}, dt_s);
    worst_N = larger(worst_N, std::abs(world.actuators()[0].tension_N));
  }
  return worst_N;
}

}  // namespace

Figures suspended_mass() {
  return {{5, "stretch under a suspended mass at rest, relative", rest_stretch_error(), 1e-9, ""},
          {5, "angular frequency of its damped oscillation at 0.1 ms, relative", frequency_error(),
           1e-3, ""},
          {5, "tension of a slack tendon", slack_tension_N(), 0, "N"}};
}

}  // namespace accuracy
