#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "sim/actuator/motor.hpp"
#include "sim/residuals/chain_residuals.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::residuals;

namespace {

constexpr double period_s = 0.002;

/// A value for some rows, then another: what a lossy bus makes of a smooth command.
Signal leaping(double low, double high, int rows) {
  std::mt19937_64 random(1);
  Signal x;
  while (int(x.size()) < rows) {
    const double value = std::uniform_real_distribution(low, high)(random);
    x.insert(x.end(), 1 + random() % 6, value);
  }
  x.resize(std::size_t(rows));
  return x;
}

double rms(const std::vector<double>& x) {
  double square = 0;
  for (const double value : x) square += value * value;
  return std::sqrt(square / double(x.size()));
}

}  // namespace

TEST_CASE(
    "under a window a motion whose acceleration leaps from sample to sample comes out exactly") {
  const Signal held = leaping(-300, 300, 101);
  Signal speed{2}, x{1}, around{0};
  for (std::size_t k = 0; k + 1 < held.size(); ++k) {
    x.push_back(x[k] + period_s * (speed[k] + period_s / 2 * held[k]));
    speed.push_back(speed[k] + period_s * held[k]);
    around.push_back((held[k] + held[k + 1]) / 2);
  }
  const Bump bump(0.03, period_s);
  for (const std::size_t k : {20u, 33u, 50u, 71u}) {
    INFO(k);
    CHECK(bump.acceleration(x, k) == Approx(bump.mean(around, k)).epsilon(1e-9));
  }
}

TEST_CASE("a motor whose voltage leaps leaves less than the noise of its sensors") {
  const erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  const erp::Actuator& actuator = robot.actuators[0];
  const erp::MotorType& type = robot.motor_of(actuator);
  const sim::Motor motor(type, actuator.spindle.radius_m);
  const int rows = 2000;
  ActuatorSignals s;
  s.voltage_V = leaping(5, 11, rows), s.tension_N = Signal(rows, 10.0);
  sim::MotorState state;
  for (const double volts : s.voltage_V) {  // row k: volts, and what there is after them
    state = sim::step(motor, state, volts, 10.0, period_s);
    s.current_A.push_back(state.current_A), s.shaft_rad.push_back(state.shaft_rad);
  }
  PathTrace no_path;
  const ChainTrace t = trace({type, actuator, {}, 0}, s, no_path, period_s, 0.006);
  std::vector<std::size_t> middles;
  for (std::size_t k = 100; k + 100 < rows; k += 10) middles.push_back(k);
  const Episode episode{"leaping", period_s, rows, {}, {}};
  const auto left = chain_residuals(t, actuator, type, episode, Bump(0.03, period_s), middles);
  REQUIRE(left.size() == 2);
  CHECK(rms(left[0].value) < 2e-4 * left[0].driven_by);  // an encoder's noise is as much
  CHECK(rms(left[1].value) < 5e-3 * left[1].driven_by);  // a current sensor's noise is twice that
}
