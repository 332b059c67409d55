#include "sim/control/gain_design.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/model/actuator/sensors.hpp"
#include "sim/model/actuator/spring.hpp"

namespace sim {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Poles = std::array<std::complex<double>, 3>;

struct Discrete {
  Matrix3d phi;
  Vector3d gamma;
};

/// e^[A B; 0 0]t = [Φ Γ; 0 1], by scaling and squaring a Taylor series.
Discrete discretized(const ForceModel& model, double t) {
  constexpr int taylor_terms = 18;  // error below rounding for a norm below 1/8
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m.topLeftCorner<3, 3>() = model.a * t;
  m.topRightCorner<3, 1>() = model.b * t;
  const int squarings = std::max(0, static_cast<int>(std::ceil(std::log2(m.norm()))) + 3);
  m /= std::pow(2.0, squarings);
  Eigen::Matrix4d term = Eigen::Matrix4d::Identity(), sum = term;
  for (int k = 1; k <= taylor_terms; ++k) term = term * m / k, sum += term;
  for (int k = 0; k < squarings; ++k) sum = sum * sum;
  return {sum.topLeftCorner<3, 3>(), sum.topRightCorner<3, 1>()};
}

/// The open-loop poles, with the slowest moved to −bandwidth.
Poles default_poles(const ForceModel& model, double bandwidth_per_s) {
  const auto open_loop = model.a.eigenvalues();
  Poles poles{open_loop[0], open_loop[1], open_loop[2]};
  std::sort(poles.begin(), poles.end(), [](auto x, auto y) { return std::abs(x) < std::abs(y); });
  if (poles[0].imag() != 0)
    throw std::invalid_argument(
        "the open-loop poles of motor and tendon are complex; set force_poles_per_s explicitly");
  poles[0] = -bandwidth_per_s;
  return poles;
}

Poles desired_poles(const ForceModel& model, const DesignOptions& options) {
  const bool has_poles =
      std::any_of(options.force_poles_per_s.begin(), options.force_poles_per_s.end(),
                  [](auto p) { return p != std::complex<double>(); });
  const Poles poles =
      has_poles ? options.force_poles_per_s : default_poles(model, options.force_bandwidth_per_s);
  for (const auto& pole : poles)
    if (!(pole.real() < 0))
      throw std::invalid_argument("force poles must be stable, got real part " +
                                  std::to_string(pole.real()));
  return poles;
}

/// p(Φ) = Π (Φ − e^(pole · t)), with real coefficients.
Matrix3d polynomial(const Matrix3d& phi, const Poles& poles, double t) {
  Eigen::Matrix3cd product = Eigen::Matrix3cd::Identity();
  for (const auto& pole : poles)
    product = product * (phi - std::exp(pole * t) * Eigen::Matrix3cd::Identity());
  if (product.imag().norm() > 1e-9 * product.real().norm())
    throw std::invalid_argument("complex force poles must come in conjugate pairs");
  return product.real();
}

double mechanical_pole_per_s(const erp::MotorType& m) {
  // Without inductance: λ_m = (e N² (K_T K_E / R + µ_M) + µ_G) / J
  const double n2 = m.gear_ratio * m.gear_ratio, eta = m.gear_efficiency;
  const double damping = eta * n2 *
                             (m.torque_Nm_per_A * m.back_emf_V_s_per_rad / m.resistance_ohm +
                              m.rotor_viscous_Nm_s_per_rad) +
                         m.gear_viscous_Nm_s_per_rad;
  return damping / (eta * n2 * m.rotor_inertia_kg_m2 + m.gear_inertia_kg_m2);
}

}  // namespace

ForceModel force_model(const erp::MotorType& m, const erp::Tendon& tendon, double r) {
  const double n = m.gear_ratio, eta = m.gear_efficiency;
  const double inertia = eta * n * n * m.rotor_inertia_kg_m2 + m.gear_inertia_kg_m2;
  const double viscous = eta * n * n * m.rotor_viscous_Nm_s_per_rad + m.gear_viscous_Nm_s_per_rad;
  ForceModel model;
  model.a.row(0) << -m.resistance_ohm / m.inductance_H,
      -m.back_emf_V_s_per_rad * n / m.inductance_H, 0;
  model.a.row(1) << eta * n * m.torque_Nm_per_A / inertia, -viscous / inertia, -r / inertia;
  const Spring spring = Spring::of(tendon);
  const double kappa = spring.slope_N_per_m(spring.stretch_m(tendon.pretension_N));
  model.a.row(2) =
      Eigen::RowVector3d(0, kappa * r, 0) + tendon.damping_N_s_per_m * r * model.a.row(1);
  model.b << 1 / m.inductance_H, 0, 0;
  return model;
}

ForceGains design_force(const ForceModel& model, const DesignOptions& options) {
  if (!(options.period_s > 0)) throw std::invalid_argument("period_s must be positive");
  const auto [phi, gamma] = discretized(model, options.period_s);
  Matrix3d controllability;
  controllability << gamma, phi * gamma, phi * phi * gamma;
  const Matrix3d p = polynomial(phi, desired_poles(model, options), options.period_s);
  const Eigen::RowVector3d last_row = Eigen::RowVector3d::UnitZ();
  ForceGains gains;
  gains.feedback =
      controllability.transpose().fullPivLu().solve(last_row.transpose()).transpose() * p;
  const Matrix3d closed_loop = Matrix3d::Identity() - phi + gamma * gains.feedback;
  gains.prefilter_V_per_N = 1 / Vector3d(closed_loop.fullPivLu().solve(gamma)).z();
  return gains;
}

RestingBand resting_band(const erp::MotorType& m, double radius_m, const ForceGains& gains,
                         double force_N) {
  const double n = m.gear_ratio, eta = m.gear_efficiency, k = m.torque_Nm_per_A;
  const double load = radius_m * force_N;
  const double assumed_A = load / (eta * n * k);
  const double friction_A = (m.gear_coulomb_Nm / (eta * n) + m.rotor_coulomb_Nm) / k;
  const double holding_A = (eta * (load - m.gear_coulomb_Nm) / n - m.rotor_coulomb_Nm) / k;
  const double volt_per_A = m.resistance_ohm + gains.feedback.x();
  return {volt_per_A * friction_A / gains.prefilter_V_per_N,
          volt_per_A * (assumed_A - holding_A) / gains.feedback.z()};
}

namespace {

void set(EcuParameters& p, ecu_parameter_index index, double value) {
  p[index] = static_cast<float>(value);
}

void set_converters(EcuParameters& p, const SensorScale& scale) {
  set(p, ECU_PARAMETER_SHAFT_SCALE, scale.shaft_rad_per_count);
  set(p, ECU_PARAMETER_CURRENT_SCALE, scale.current_A_per_count);
  set(p, ECU_PARAMETER_CURRENT_COUNTS_MAX, scale.current_counts_max);
  set(p, ECU_PARAMETER_TENSION_SCALE, scale.tension_N_per_count);
  set(p, ECU_PARAMETER_TENSION_COUNTS_MAX, scale.tension_counts_max);
  set(p, ECU_PARAMETER_TENSION_ZERO, scale.tension_zero_counts);
}

const erp::Potentiometer* potentiometer_of(const erp::Robot& robot, const erp::Actuator& actuator) {
  for (const erp::Potentiometer& p : robot.potentiometers)
    if (p.actuator == actuator.name && p.ecu == actuator.ecu) return &p;
  return nullptr;
}

void set_stuck(EcuParameters& p, const erp::MotorType& motor, const erp::SensorType& sensors,
               double speed_fraction) {
  const SensorScale scale(motor, sensors);
  const double speed =
      speed_fraction * motor.supply_V / (motor.back_emf_V_s_per_rad * motor.gear_ratio);
  if (sensors.current_noise_A >= scale.current_A_per_count)
    set(p, ECU_PARAMETER_CURRENT_STUCK_SPEED, speed);
  if (sensors.tension_noise_N >= scale.tension_N_per_count)
    set(p, ECU_PARAMETER_TENSION_STUCK_SPEED, speed);
}

void set_wiper(EcuParameters& p, const erp::Potentiometer& wiper) {
  const int counts_max = (1 << wiper.bits) - 1;
  const double quantum = wiper.range_rad / counts_max;
  set(p, ECU_PARAMETER_WIPER_INPUT, wiper.input);
  set(p, ECU_PARAMETER_WIPER_SCALE, quantum);
  set(p, ECU_PARAMETER_WIPER_COUNTS_MAX, counts_max);
  set(p, ECU_PARAMETER_WIPER_TOLERANCE, 0.1 + 6 * wiper.noise_rad + 2 * quantum);
}

/// Above the limit and below the end of the converter's range; never below the limit.
double trip_level(double limit, double factor, double range) {
  return std::max(limit, std::min(factor * limit, range));
}

void set_limits(EcuParameters& p, const erp::MotorType& motor, const erp::SensorType& sensors,
                const erp::Actuator& actuator, double line_travel_m) {
  const double travel_rad = line_travel_m / actuator.spindle.radius_m;
  set(p, ECU_PARAMETER_CURRENT_LIMIT, motor.current_limit_A);
  set(p, ECU_PARAMETER_CURRENT_TRIP,
      trip_level(motor.current_limit_A, 1.5, 0.95 * sensors.current_range_A));
  set(p, ECU_PARAMETER_CURRENT_CONTINUOUS, motor.continuous_current_A);
  set(p, ECU_PARAMETER_OVERLOAD_LIMIT, motor.overload_A2_s);
  set(p, ECU_PARAMETER_TENSION_LIMIT, actuator.max_tension_N);
  set(p, ECU_PARAMETER_TENSION_TRIP,
      trip_level(actuator.max_tension_N, 1.2, 0.98 * sensors.tension_range_N));
  set(p, ECU_PARAMETER_SHAFT_MIN, -travel_rad);
  set(p, ECU_PARAMETER_SHAFT_MAX, travel_rad);
}

void set_motor(EcuParameters& p, const erp::MotorType& motor, double period_s) {
  const double back_emf = motor.back_emf_V_s_per_rad * motor.gear_ratio;
  constexpr double decay_per_period = 0.3;  // b · period, see the header
  const double current_bandwidth_per_s = decay_per_period / period_s;
  set(p, ECU_PARAMETER_SUPPLY, motor.supply_V);
  set(p, ECU_PARAMETER_RESISTANCE, motor.resistance_ohm);
  set(p, ECU_PARAMETER_BACK_EMF, back_emf);
  set(p, ECU_PARAMETER_LENGTH_KP, back_emf * mechanical_pole_per_s(motor) / 4);
  set(p, ECU_PARAMETER_CURRENT_KP, motor.inductance_H * current_bandwidth_per_s);
  set(p, ECU_PARAMETER_CURRENT_KI, motor.resistance_ohm * current_bandwidth_per_s);
  set(p, ECU_PARAMETER_CURRENT_KD, 0);
}

void set_force(EcuParameters& p, const ForceGains& force) {
  set(p, ECU_PARAMETER_FORCE_K_CURRENT, force.feedback.x());
  set(p, ECU_PARAMETER_FORCE_K_SPEED, force.feedback.y());
  set(p, ECU_PARAMETER_FORCE_K_TENSION, force.feedback.z());
  set(p, ECU_PARAMETER_FORCE_PREFILTER, force.prefilter_V_per_N);
}

}  // namespace

EcuParameters design_parameters(const erp::Robot& robot, const erp::Actuator& actuator,
                                const DesignOptions& options) {
  const erp::MotorType& motor = robot.motor_of(actuator);
  const erp::SensorType& sensors = robot.sensors_of(actuator);
  const double r = actuator.spindle.radius_m;
  EcuParameters p{};
  set_converters(p, SensorScale(motor, sensors));
  set_limits(p, motor, sensors, actuator, options.line_travel_m);
  set_stuck(p, motor, sensors, options.stuck_speed_fraction);
  if (const auto* wiper = potentiometer_of(robot, actuator)) set_wiper(p, *wiper);
  set_motor(p, motor, options.period_s);
  set_force(p, design_force(force_model(motor, actuator.tendon, r), options));
  return p;
}

}  // namespace sim
