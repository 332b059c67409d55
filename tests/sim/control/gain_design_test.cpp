#include "sim/control/gain_design.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>

#include "firmware/core/ecu.h"
#include "sim/model/actuator/motor.hpp"
#include "sim/model/actuator/sensors.hpp"
#include "sim/model/actuator/tendon.hpp"
#include "tests/sim/rigs.hpp"

using sim::DesignOptions;

namespace {

erp::Robot rig() {
  erp::Robot robot;
  robot.motor_types = {rigs::caliper()};
  erp::SensorType sensors;
  sensors.name = "ecu_12bit";
  sensors.current_noise_A = 0.015, sensors.tension_noise_N = 0.05;
  robot.sensor_types = {sensors};
  erp::Actuator flexor;
  flexor.name = "flexor", flexor.motor = "caliper_12V", flexor.sensors = "ecu_12bit";
  flexor.max_tension_N = 150;
  flexor.spindle.radius_m = rigs::spindle_radius_m;
  flexor.tendon = rigs::hinge_tendon();
  flexor.tendon.pretension_N = 2;
  robot.actuators = {flexor};
  return robot;
}

/// The firmware, the motor and a tendon with a fixed distal end.
class Bench {
 public:
  explicit Bench(const erp::Robot& robot = rig(), std::uint64_t seed = 1)
      : robot_(robot),
        motor_(robot_.motor_types[0], rigs::spindle_radius_m),
        tendon_(
            sim::TendonLaw::at_rest(robot_.actuators[0].tendon, robot_.actuators[0].spindle, 0.3)),
        sensors_(robot_.motor_types[0], robot_.sensor_types[0], seed) {
    ecu_init(&ecu_);
    const auto gains = sim::design_parameters(robot_, robot_.actuators[0], {});
    for (std::size_t k = 0; k < gains.size(); ++k)
      ecu_parameter(&ecu_, std::uint8_t(k), gains[k], k + 1 == gains.size());
    ecu_command(&ecu_, ECU_REQUEST_ARM, 0);
  }
  double tension_N() const { return tendon_.tension_N(0.3, 0, x_.shaft_rad, x_.speed_rad_per_s); }
  double current_A() const { return x_.current_A; }
  double shaft_rad() const { return x_.shaft_rad; }
  ecu_state state() const { return ecu_.state; }
  const sim::SensorScale& scale() const { return sensors_.scale(); }

  void tick(ecu_request request, double setpoint) {
    ecu_command(&ecu_, request, std::int32_t(std::lround(setpoint)));
    const auto counts = sensors_.read(x_.shaft_rad, x_.current_A, tension_N());
    const ecu_inputs inputs{counts.encoder, counts.current, counts.tension};
    const double voltage_V = 12.0 * ecu_tick(&ecu_, &inputs) / ECU_DUTY_MAX;
    for (int k = 0; k < 20; ++k) x_ = step(motor_, x_, voltage_V, tension_N(), 1e-4);
  }
  void hold_force(double force_N, double t_s) {
    for (int k = 0; k < std::lround(t_s / 0.002); ++k) tick(ECU_REQUEST_FORCE, 1000 * force_N);
  }

 private:
  erp::Robot robot_;
  sim::Motor motor_;
  sim::TendonLaw tendon_;
  sim::ActuatorSensors sensors_;
  sim::MotorState x_;
  ecu_channel ecu_;
};

}  // namespace

TEST_CASE("the model has the published poles and a slow pole for winding up the tendon") {
  const auto model = sim::force_model(rigs::without_friction(rigs::caliper()), rigs::hinge_tendon(),
                                      rigs::spindle_radius_m);
  auto poles = Eigen::Vector3d(model.a.eigenvalues().real());
  std::sort(poles.begin(), poles.end());
  CHECK(poles[0] == Approx(-8825).epsilon(1e-3));
  CHECK(poles[1] == Approx(-180).epsilon(0.1));
  CHECK(std::abs(poles[2]) < 1.0);
}

TEST_CASE("the tension rate of the model equals that of the tendon law") {
  erp::Tendon tendon = rigs::hinge_tendon();
  tendon.damping_N_s_per_m = 300;
  const double r = rigs::spindle_radius_m, h = 1e-6;
  const auto model = sim::force_model(rigs::caliper(), tendon, r);
  const auto law = sim::TendonLaw::at_rest(tendon, {{}, r}, 0.3);
  const double shaft = 1.2, speed = 3, current = 2;
  const Eigen::Vector3d x(current, speed, law.tension_N(0.3, 0, shaft, speed));
  const Eigen::Vector3d rate = model.a * x;
  const double later_N = law.tension_N(0.3, 0, shaft + h * speed, speed + h * rate.y());
  CHECK(rate.z() == Approx((later_N - x.z()) / h).epsilon(1e-6));
}

TEST_CASE("Ackermann's formula places the discrete poles at the desired values") {
  const auto model =
      sim::force_model(rigs::caliper(), rigs::hinge_tendon(), rigs::spindle_radius_m);
  DesignOptions options;
  const auto poles = GENERATE(std::array<std::complex<double>, 3>{-40.0, -200.0, -900.0},
                              std::array<std::complex<double>, 3>{{{-60, 20}, {-60, -20}, -800.0}});
  options.force_poles_per_s = poles;
  const auto gains = sim::design_force(model, options);
  // Φ − Γ k from the differential equation, column by column, by fine Euler–Heun steps.
  const auto after_period = [&](Eigen::Vector3d x, double v) {
    const int fine_steps = 200000;
    const double h = 0.002 / fine_steps;
    for (int k = 0; k < fine_steps; ++k) {
      const Eigen::Vector3d rate = model.a * x + model.b * v;
      x += h * (rate + 0.5 * h * model.a * rate);
    }
    return x;
  };
  Eigen::Matrix3d closed;
  for (int k = 0; k < 3; ++k)
    closed.col(k) = after_period(Eigen::Vector3d::Unit(k), -gains.feedback[k]);
  const auto discrete_poles = closed.eigenvalues();
  for (const auto& pole : poles) {
    double nearest = 1;
    for (int k = 0; k < 3; ++k)
      nearest = std::min(nearest, std::abs(discrete_poles[k] - std::exp(pole * 0.002)));
    CHECK(nearest < 1e-6);
  }
}

TEST_CASE("without friction the prefilter gives zero steady-state error") {
  erp::MotorType motor = rigs::without_friction(rigs::caliper());
  const auto model = sim::force_model(motor, rigs::hinge_tendon(), rigs::spindle_radius_m);
  const auto gains = sim::design_force(model, {});
  // At rest ω = 0, V = R i, i = r F / (η N K_T); the law must return this V.
  const double force = 40, current = rigs::spindle_radius_m * force / (0.59 * 128 * 11.5e-3);
  const double voltage =
      gains.prefilter_V_per_N * force - gains.feedback.x() * current - gains.feedback.z() * force;
  CHECK(voltage == Approx(0.516 * current).epsilon(1e-6));
}

TEST_CASE("poles that are unstable or not in conjugate pairs are rejected") {
  const auto model =
      sim::force_model(rigs::caliper(), rigs::hinge_tendon(), rigs::spindle_radius_m);
  DesignOptions options;
  options.force_poles_per_s = {1.0, -2.0, -3.0};
  CHECK_THROWS_AS(sim::design_force(model, options), std::invalid_argument);
  options.force_poles_per_s = {std::complex<double>(-10, 50), -20.0, -300.0};
  CHECK_THROWS_AS(sim::design_force(model, options), std::invalid_argument);
}

TEST_CASE(
    "a force step from 2 to 40 N takes less than 0.2 s, without overshoot, with less than 0.1 N of "
    "noise at rest and within the current limit") {
  Bench bench;
  bench.hold_force(2, 0.5);
  double at_10 = -1, at_90 = -1, peak = 0, current = 0;
  for (int k = 0; k < 400; ++k) {
    bench.hold_force(40, 0.002);
    const double t = 0.002 * (k + 1), f = bench.tension_N();
    if (at_10 < 0 && f > 2 + 0.1 * 38) at_10 = t;
    if (at_90 < 0 && f > 2 + 0.9 * 38) at_90 = t;
    peak = std::max(peak, f), current = std::max(current, std::abs(bench.current_A()));
  }
  double squares = 0;
  for (int k = 0; k < 1000; ++k) {
    bench.hold_force(40, 0.002);
    squares += std::pow(bench.tension_N() - 40, 2) / 1000;
  }
  CAPTURE(at_90 - at_10, peak, current, std::sqrt(squares));
  CHECK(bench.state() == ECU_STATE_RUNNING);
  CHECK(at_90 - at_10 <= 0.200);
  CHECK(at_90 - at_10 >= 0.130);  // lower bound from the motor's speed
  CHECK(peak < 40.4);
  CHECK(std::sqrt(squares) <= 0.1);
  CHECK(current < 4.2);
}

TEST_CASE("without noise the tension at rest is within resting_band, from below and from above") {
  erp::Robot quiet = rig();
  quiet.sensor_types[0].current_noise_A = quiet.sensor_types[0].tension_noise_N = 0;
  const double force = GENERATE(10.0, 40.0, 120.0), from = GENERATE(2.0, 140.0);
  Bench bench(quiet);
  bench.hold_force(from, 2.0);
  bench.hold_force(force, 2.0);
  const auto gains = sim::design_force(
      sim::force_model(rigs::caliper(), rigs::hinge_tendon(), rigs::spindle_radius_m), {});
  const auto band = sim::resting_band(rigs::caliper(), rigs::spindle_radius_m, gains, force);
  const double half_quanta = 0.5 * 200 / 4095 + 0.5 * 12.0 / 1023 / gains.feedback.z();
  CAPTURE(force, from, bench.tension_N() - force, band.below_N, band.above_N);
  CHECK(bench.tension_N() > force - band.below_N - half_quanta);
  CHECK(bench.tension_N() < force + band.above_N + half_quanta);
  // After unwinding, the tension at rest is above the reference, as resting_band predicts.
  if (from > force) CHECK(bench.tension_N() > force + 0.5 * band.above_N - half_quanta);
}

TEST_CASE("while unwinding, when the load drives the motor, the force loop is stable") {
  Bench bench;
  bench.hold_force(60, 1.5);
  double lowest = 60;
  for (int k = 0; k < 500; ++k)
    bench.hold_force(10, 0.002), lowest = std::min(lowest, bench.tension_N());
  CHECK(lowest > 9.4);
  CHECK(std::abs(bench.tension_N() - 10) < 0.4);
}

TEST_CASE("the length loop reaches its reference without overshoot") {
  Bench bench;
  const double target = 5000;  // counts
  double peak = 0;
  for (int k = 0; k < 500; ++k) {
    bench.tick(ECU_REQUEST_LENGTH, target);
    peak = std::max(peak, bench.shaft_rad());
  }
  const double reference = target * bench.scale().shaft_rad_per_count;
  CHECK(bench.shaft_rad() == Approx(reference).margin(0.003));
  CHECK(peak < reference * 1.02);
}

TEST_CASE("with a sticking shaft the current loop settles within ten periods") {
  Bench bench;
  for (int k = 0; k < 25; ++k) bench.tick(ECU_REQUEST_CURRENT, 25);
  double mean = 0;
  for (int k = 0; k < 500; ++k)
    bench.tick(ECU_REQUEST_CURRENT, 25), mean += bench.current_A() / 500;
  CHECK(mean == Approx(0.025).margin(0.002));
}

TEST_CASE("every parameter is set and accepted by the firmware") {
  CHECK(Bench().state() == ECU_STATE_ARMED);
}
