#include "sim/model/actuator/motor.hpp"

#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "tests/bench/accuracy/figure.hpp"
#include "tests/bench/accuracy/motor_energy.hpp"
#include "tests/sim/rigs.hpp"

namespace accuracy {
namespace {

using rigs::spindle_radius_m, sim::MotorState;

const erp::MotorType m = rigs::caliper();
const double n = m.gear_ratio, eta = m.gear_efficiency, k = m.torque_Nm_per_A;

/// Constant voltage and tension.
struct Load {
  double voltage_V, tension_N;
};

/// The matrix M of eq. 3 for a driving motor that winds up the line:
///   d/dt (i, ω, θ, 1) = M (i, ω, θ, 1)
///   L di/dt = V − R i − K_E N ω
///   J dω/dt = η N (K_T i − µ_M N ω − τ_CM) − µ_G ω − τ_CG − r F,  J = η J_M N² + J_G
Eigen::Matrix4d winding_matrix(const Load& load) {
  const double inertia = eta * m.rotor_inertia_kg_m2 * n * n + m.gear_inertia_kg_m2;
  const double viscous = eta * m.rotor_viscous_Nm_s_per_rad * n * n + m.gear_viscous_Nm_s_per_rad;
  const double resisting_Nm =
      eta * n * m.rotor_coulomb_Nm + m.gear_coulomb_Nm + spindle_radius_m * load.tension_N;
  Eigen::Matrix4d rate = Eigen::Matrix4d::Zero();
  rate.row(0) << -m.resistance_ohm, -m.back_emf_V_s_per_rad * n, 0, load.voltage_V;
  rate.row(0) /= m.inductance_H;
  rate.row(1) << eta * n * k / inertia, -viscous / inertia, 0, -resisting_Nm / inertia;
  rate(2, 1) = 1;
  return rate;
}

Eigen::Vector4d vector_of(const MotorState& x) {
  return {x.current_A, x.speed_rad_per_s, x.shaft_rad, 1};
}

const MotorState start{0.5, 1.0, 0.3};  // chosen
constexpr Load lifting{9, 40};          // chosen

double exponential_error(const sim::Motor& motor) {
  double worst = 0;
  for (int i = 1; i <= 200; ++i) {
    const double t = 1e-4 * i;
    // x(t) = exp(M t) x(0)
    const Eigen::Matrix4d transition = (winding_matrix(lifting) * t).exp();
    const MotorState end_state = step(motor, start, lifting.voltage_V, lifting.tension_N, t);
    worst =
        larger(worst, (transition * vector_of(start) - vector_of(end_state)).cwiseAbs().maxCoeff());
  }
  return worst;
}

double runge_kutta_error(const sim::Motor& motor) {
  const int steps = 20000;
  const double t = 0.02, h = t / steps;
  const Eigen::Matrix4d rate = winding_matrix(lifting);
  Eigen::Vector4d x = vector_of(start);
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector4d k1 = rate * x, k2 = rate * (x + h / 2 * k1), k3 = rate * (x + h / 2 * k2),
                          k4 = rate * (x + h * k3);
    x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  const MotorState end_state = step(motor, start, lifting.voltage_V, lifting.tension_N, t);
  return (x - vector_of(end_state)).cwiseAbs().maxCoeff();
}

double steady_error_rad_per_s(const sim::Motor& motor) {
  double worst = 0;
  for (const Load& load : {Load{6, 80}, Load{9, 40}, Load{12, 0}, Load{12, 120}}) {  // chosen
    // ω = (η N (K_T V/R − τ_CM) − τ_CG − r F) / (η N² (K_T K_E/R + µ_M) + µ_G)
    const double drive_Nm = eta * n * (k * load.voltage_V / m.resistance_ohm - m.rotor_coulomb_Nm) -
                            m.gear_coulomb_Nm - spindle_radius_m * load.tension_N;
    const double back_emf_Nm_s = k * m.back_emf_V_s_per_rad / m.resistance_ohm;
    const double drag_Nm_s =
        eta * n * n * (back_emf_Nm_s + m.rotor_viscous_Nm_s_per_rad) + m.gear_viscous_Nm_s_per_rad;
    const MotorState end_state = step(motor, {}, load.voltage_V, load.tension_N, 2);
    worst = larger(worst, std::abs(end_state.speed_rad_per_s - drive_Nm / drag_Nm_s));
  }
  return worst;
}

double locked_error_A(const sim::Motor& motor) {
  const double voltage_V = m.resistance_ohm * 0.02;  // chosen: 0.02 A does not overcome friction
  double worst = 0;
  for (double t = 1e-5; t < 1e-3; t += 1e-5) {
    // i = V/R (1 − e^(−R t/L))
    const double exact_A =
        voltage_V / m.resistance_ohm * -std::expm1(-m.resistance_ohm / m.inductance_H * t);
    worst = larger(worst, std::abs(step(motor, {}, voltage_V, 0, t).current_A - exact_A));
  }
  return worst;
}

double rotation_below_friction_rad(const sim::Motor& motor) {
  // the current that balances the friction on the motor's shaft: τ_CM + τ_CG / (η N)
  const double friction_A = (m.rotor_coulomb_Nm + m.gear_coulomb_Nm / (eta * n)) / k;
  double worst = 0;
  for (const double fraction : {-0.9999, -0.5, 0.5, 0.9999}) {
    MotorState x;
    for (int i = 0; i < 10000; ++i)
      x = step(motor, x, fraction * friction_A * m.resistance_ohm, 0, 1e-3);
    worst = larger(worst, std::abs(x.shaft_rad));
  }
  return worst;
}

}  // namespace

Figures motor() {
  const sim::Motor motor(m, spindle_radius_m);
  const MotorAudit audit = audit_motor(m);
  return {{4, "motor lifting 40 N at 9 V for up to 20 ms, against the matrix exponential",
           exponential_error(motor), 1e-10, "A, rad/s, rad"},
          {4, "same motor after 20 ms, against Runge–Kutta with steps of 1 µs",
           runge_kutta_error(motor), 1e-10, "A, rad/s, rad"},
          {4, "steady speed under four loads", steady_error_rad_per_s(motor), 1e-9, "rad/s"},
          {4, "current of a locked shaft", locked_error_A(motor), 1e-12, "A"},
          {4, "rotation in 10 s of a shaft with a load below its friction",
           rotation_below_friction_rad(motor), 0, "rad"},
          {4, "energy balance error / energy converted, in all four quadrants", audit.balance_error,
           1e-6, ""},
          {4, "power generated by the gearbox", audit.gearbox_generated_W, 0, "W"}};
}

}  // namespace accuracy
