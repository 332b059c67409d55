#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "sim/gap/residuals/chain_residuals.hpp"
#include "sim/model/actuator/motor.hpp"
#include "sim/model/actuator/noise.hpp"
#include "sim/model/actuator/sensors.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::residuals;

namespace {

constexpr double leap_period_s = 0.002, pull_N = 10;
constexpr int rows = 2000;

/// Random steps, like a smooth command after a bus that loses frames.
Signal random_steps(double low, double high, int count) {
  std::mt19937_64 random(1);
  Signal x;
  while (int(x.size()) < count) {
    const double value = std::uniform_real_distribution(low, high)(random);
    x.insert(x.end(), 1 + random() % 6, value);
  }
  x.resize(std::size_t(count));
  return x;
}

double rms_of_signal(const std::vector<double>& x) {
  double square = 0;
  for (const double value : x) square += value * value;
  return std::sqrt(square / double(x.size()));
}

/// Simulates a motor with voltage steps and a constant tension. `averaged`: currents are means
/// around the rows, otherwise values at the rows.
ActuatorSignals driven(const erp::Robot& robot, const erp::Actuator& actuator, bool averaged) {
  constexpr int substeps = 40;
  const sim::Motor motor(robot.motor_of(actuator), actuator.spindle.radius_m,
                         leap_period_s / substeps);
  ActuatorSignals s;
  s.voltage_V = random_steps(5, 11, rows), s.tension_N = Signal(rows, pull_N);
  s.current_around = averaged;
  sim::MotorState state;
  Signal mean_A;
  for (const double volts :
       s.voltage_V) {  // row k: the voltage, and the state at the end of its period
    mean_A.push_back(0);
    for (int p = 0; p < substeps; ++p) {
      const double before_A = state.current_A;
      state = sim::step(motor, state, volts, pull_N, leap_period_s / substeps);
      mean_A.back() += (before_A + state.current_A) / 2 / substeps;
    }
    s.current_A.push_back(state.current_A), s.shaft_rad.push_back(state.shaft_rad);
  }
  if (averaged)
    for (std::size_t k = 0; k + 1 < rows; ++k) s.current_A[k] = (mean_A[k] + mean_A[k + 1]) / 2;
  return s;
}

/// Adds noise and quantization of the sensors.
ActuatorSignals noisy(const erp::Robot& robot, const erp::Actuator& actuator, ActuatorSignals s) {
  const erp::SensorType& sensors = robot.sensors_of(actuator);
  const sim::SensorScale scale(robot.motor_of(actuator), sensors);
  sim::Noise noise(1);
  for (double& x : s.current_A)
    x += sensors.current_noise_A * noise.normal() +
         scale.current_A_per_count * (noise.uniform() - 0.5);
  for (double& x : s.shaft_rad) x += scale.shaft_rad_per_count * (noise.uniform() - 0.5);
  return s;
}

/// The residuals of motor and gearbox.
std::vector<Residual> stages_of(const erp::Robot& robot, const erp::Actuator& actuator,
                                const ActuatorSignals& s) {
  const erp::MotorType& type = robot.motor_of(actuator);
  const PathTrace no_path;
  const ChainTrace t = trace({type, actuator, {}, 0}, s, no_path, leap_period_s, 0.006);
  std::vector<std::size_t> middles;
  for (std::size_t k = 100; k + 100 < rows; k += 10) middles.push_back(k);
  const Episode episode{"random_steps", leap_period_s, rows, {}, {}};
  return chain_residuals(t, actuator, type, episode, Bump(0.03, leap_period_s), middles);
}

}  // namespace

TEST_CASE(
    "a window gives the mean acceleration of a motion with random acceleration steps exactly") {
  const Signal acceleration = random_steps(-300, 300, 101);
  Signal speed{2}, x{1}, averaged{0};
  for (std::size_t k = 0; k + 1 < acceleration.size(); ++k) {
    x.push_back(x[k] + leap_period_s * (speed[k] + leap_period_s / 2 * acceleration[k]));
    speed.push_back(speed[k] + leap_period_s * acceleration[k]);
    averaged.push_back((acceleration[k] + acceleration[k + 1]) / 2);
  }
  const Bump bump(0.03, leap_period_s);
  for (const std::size_t k : {20u, 33u, 50u, 71u}) {
    INFO(k);
    CHECK(bump.acceleration(x, k) == Approx(bump.mean(averaged, k)).epsilon(1e-9));
  }
}

TEST_CASE("voltage steps leave residuals of motor and gearbox below the sensor noise") {
  const erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  const erp::Actuator& actuator = robot.actuators[0];
  for (const bool averaged : {false, true}) {
    const ActuatorSignals exact = driven(robot, actuator, averaged);
    const auto residuals = stages_of(robot, actuator, exact);
    const auto with_noise = stages_of(robot, actuator, noisy(robot, actuator, exact));
    REQUIRE(residuals.size() == 2);
    for (std::size_t stage = 0; stage < 2; ++stage) {
      std::vector<double> noise;
      for (std::size_t k = 0; k < residuals[stage].value.size(); ++k)
        noise.push_back(with_noise[stage].value[k] - residuals[stage].value[k]);
      INFO((stage == 0 ? "motor" : "gearbox") << (averaged ? ", currents averaged" : ""));
      CHECK(rms_of_signal(residuals[stage].value) < 0.75 * rms_of_signal(noise));
    }
  }
}
