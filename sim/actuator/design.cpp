#include "sim/actuator/design.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/actuator/sensors.hpp"

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
Discrete hold(const ForceModel& model, double t) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m.topLeftCorner<3, 3>() = model.a * t;
  m.topRightCorner<3, 1>() = model.b * t;
  const int squarings = std::max(0, static_cast<int>(std::ceil(std::log2(m.norm()))) + 3);
  m /= std::pow(2.0, squarings);
  Eigen::Matrix4d term = Eigen::Matrix4d::Identity(), sum = term;
  for (int k = 1; k <= 18; ++k) term = term * m / k, sum += term;
  for (int k = 0; k < squarings; ++k) sum = sum * sum;
  return {sum.topLeftCorner<3, 3>(), sum.topRightCorner<3, 1>()};
}

/// The model's own poles, with the slowest moved to −bandwidth.
Poles default_poles(const ForceModel& model, double bandwidth_per_s) {
  const Vector3d::Scalar none = 0;
  const auto own = model.a.eigenvalues();
  Poles poles{own[0], own[1], own[2]};
  std::sort(poles.begin(), poles.end(),
            [](auto x, auto y) { return std::abs(x) < std::abs(y); });
  if (std::abs(poles[0].imag()) > none)
    throw std::invalid_argument(
        "the tendon and its motor oscillate; give force_poles_per_s explicitly");
  poles[0] = -bandwidth_per_s;
  return poles;
}

Poles wanted_poles(const ForceModel& model, const DesignOptions& options) {
  const bool given = std::any_of(options.force_poles_per_s.begin(),
                                 options.force_poles_per_s.end(),
                                 [](auto p) { return p != std::complex<double>(); });
  const Poles poles =
      given ? options.force_poles_per_s : default_poles(model, options.force_bandwidth_per_s);
  for (const auto& pole : poles)
    if (!(pole.real() < 0))
      throw std::invalid_argument("force poles must be stable, got real part " +
                                  std::to_string(pole.real()));
  return poles;
}

/// p(Φ) = Π (Φ − e^(pole · t)), its coefficients real.
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
  const double damping = eta * n2 * (m.torque_Nm_per_A * m.back_emf_V_s_per_rad /
                                         m.resistance_ohm +
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
  model.a.row(2) = Eigen::RowVector3d(0, tendon.stiffness_N_per_m * r, 0) +
                   tendon.damping_N_s_per_m * r * model.a.row(1);
  model.b << 1 / m.inductance_H, 0, 0;
  return model;
}

ForceGains design_force(const ForceModel& model, const DesignOptions& options) {
  if (!(options.period_s > 0)) throw std::invalid_argument("period_s must be positive");
  const auto [phi, gamma] = hold(model, options.period_s);
  Matrix3d reach;
  reach << gamma, phi * gamma, phi * phi * gamma;
  const Matrix3d p = polynomial(phi, wanted_poles(model, options), options.period_s);
  const Eigen::RowVector3d last = Eigen::RowVector3d::UnitZ();
  ForceGains gains;
  gains.feedback = reach.transpose().fullPivLu().solve(last.transpose()).transpose() * p;
  const Matrix3d closed = Matrix3d::Identity() - phi + gamma * gains.feedback;
  gains.prefilter_V_per_N = 1 / Vector3d(closed.fullPivLu().solve(gamma)).z();
  return gains;
}

double resting_error_N(const erp::MotorType& m, const ForceGains& gains) {
  const double drive = m.gear_efficiency * m.gear_ratio;
  const double friction_A =
      (drive * m.rotor_coulomb_Nm + m.gear_coulomb_Nm) / (drive * m.torque_Nm_per_A);
  return (m.resistance_ohm + gains.feedback.x()) * friction_A / gains.prefilter_V_per_N;
}

EcuParameters design_parameters(const erp::Robot& robot, const erp::Actuator& actuator,
                                const DesignOptions& options) {
  const erp::MotorType& motor = robot.motor_of(actuator);
  const erp::SensorType& sensors = robot.sensors_of(actuator);
  const SensorScale scale(motor, sensors);
  const double r = actuator.spindle.radius_m;
  const double back_emf = motor.back_emf_V_s_per_rad * motor.gear_ratio;
  const double current_bandwidth_per_s = 0.3 / options.period_s;
  const ForceGains force = design_force(force_model(motor, actuator.tendon, r), options);
  EcuParameters p{};
  const auto set = [&p](ecu_parameter_index index, double value) {
    p[index] = static_cast<float>(value);
  };
  set(ECU_PARAMETER_SUPPLY, motor.supply_V);
  set(ECU_PARAMETER_SHAFT_SCALE, scale.shaft_rad_per_count);
  set(ECU_PARAMETER_CURRENT_SCALE, scale.current_A_per_count);
  set(ECU_PARAMETER_CURRENT_COUNTS_MAX, scale.current_counts_max);
  set(ECU_PARAMETER_TENSION_SCALE, scale.tension_N_per_count);
  set(ECU_PARAMETER_TENSION_COUNTS_MAX, scale.tension_counts_max);
  set(ECU_PARAMETER_RESISTANCE, motor.resistance_ohm);
  set(ECU_PARAMETER_BACK_EMF, back_emf);
  set(ECU_PARAMETER_CURRENT_LIMIT, motor.current_limit_A);
  set(ECU_PARAMETER_CURRENT_TRIP,
      std::max(motor.current_limit_A,
               std::min(1.5 * motor.current_limit_A, 0.95 * sensors.current_range_A)));
  set(ECU_PARAMETER_TENSION_LIMIT, actuator.max_tension_N);
  set(ECU_PARAMETER_TENSION_TRIP,
      std::max(actuator.max_tension_N,
               std::min(1.2 * actuator.max_tension_N, 0.98 * sensors.tension_range_N)));
  set(ECU_PARAMETER_SHAFT_MIN, -options.line_travel_m / r);
  set(ECU_PARAMETER_SHAFT_MAX, options.line_travel_m / r);
  set(ECU_PARAMETER_LENGTH_KP, back_emf * mechanical_pole_per_s(motor) / 4);
  set(ECU_PARAMETER_CURRENT_KP, motor.inductance_H * current_bandwidth_per_s);
  set(ECU_PARAMETER_CURRENT_KI, motor.resistance_ohm * current_bandwidth_per_s);
  set(ECU_PARAMETER_CURRENT_KD, 0);
  set(ECU_PARAMETER_FORCE_K_CURRENT, force.feedback.x());
  set(ECU_PARAMETER_FORCE_K_SPEED, force.feedback.y());
  set(ECU_PARAMETER_FORCE_K_TENSION, force.feedback.z());
  set(ECU_PARAMETER_FORCE_PREFILTER, force.prefilter_V_per_N);
  return p;
}

}  // namespace sim
