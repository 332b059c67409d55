#include "tests/bench/accuracy/motor_energy.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/actuator/motor.hpp"
#include "tests/bench/accuracy/figure.hpp"
#include "tests/sim/rigs.hpp"

namespace accuracy {
namespace {

using rigs::spindle_radius_m, sim::MotorState;

struct Run {
  double speed_rad_per_s, voltage_V, tension_N;  ///< initial speed
};

/// Powers at one instant, or energies over a period.
struct Powers {
  double electrical_W = 0, copper_W = 0, friction_W = 0, gear_W = 0, line_W = 0;
  void add(double weight, const Powers& other) {
    electrical_W += weight * other.electrical_W, copper_W += weight * other.copper_W;
    friction_W += weight * other.friction_W, gear_W += weight * other.gear_W;
    line_W += weight * other.line_W;
  }
  double balance_W() const { return electrical_W - copper_W - friction_W - gear_W - line_W; }
  double sum_of_magnitudes_W() const {
    return std::abs(electrical_W) + copper_W + friction_W + gear_W + std::abs(line_W);
  }
};

// Mesh torque, motor.hpp:  T = e (N τ_m J_G + J_M N² X) / (e J_M N² + J_G)
//   τ_m = K_T i − µ_M N ω − s τ_CM, X = µ_G ω + s τ_CG + r F, e = η where T ω ≥ 0, else 1/η
// The gearbox dissipates (1/e − 1) T ω.
double gearbox_loss_W(const erp::MotorType& m, const MotorState& x, double tension_N) {
  const double w = x.speed_rad_per_s, n = m.gear_ratio, sign = w > 0 ? 1 : w < 0 ? -1 : 0;
  const double rotor_Nm = m.torque_Nm_per_A * x.current_A - m.rotor_viscous_Nm_s_per_rad * n * w -
                          sign * m.rotor_coulomb_Nm;
  const double load_Nm =
      m.gear_viscous_Nm_s_per_rad * w + sign * m.gear_coulomb_Nm + spindle_radius_m * tension_N;
  const double mesh = n * rotor_Nm * m.gear_inertia_kg_m2 + m.rotor_inertia_kg_m2 * n * n * load_Nm;
  const double e = mesh * w >= 0 ? m.gear_efficiency : 1 / m.gear_efficiency;
  const double inertia = e * m.rotor_inertia_kg_m2 * n * n + m.gear_inertia_kg_m2;
  return (1 / e - 1) * e * mesh / inertia * w;
}

Powers powers(const erp::MotorType& m, const MotorState& x, const Run& run) {
  const double i = x.current_A, w = x.speed_rad_per_s, n = m.gear_ratio;
  const double viscous = m.rotor_viscous_Nm_s_per_rad * n * n + m.gear_viscous_Nm_s_per_rad;
  const double coulomb_Nm = m.rotor_coulomb_Nm * n + m.gear_coulomb_Nm;
  return {run.voltage_V * i, m.resistance_ohm * i * i, viscous * w * w + coulomb_Nm * std::abs(w),
          gearbox_loss_W(m, x, run.tension_N), spindle_radius_m * run.tension_N * w};
}

// ½ L i² + ½ (J_M N² + J_G) ω²
double stored_J(const erp::MotorType& m, const MotorState& x) {
  const double inertia = m.rotor_inertia_kg_m2 * m.gear_ratio * m.gear_ratio + m.gear_inertia_kg_m2;
  return 0.5 * m.inductance_H * x.current_A * x.current_A +
         0.5 * inertia * x.speed_rad_per_s * x.speed_rad_per_s;
}

// Σ ∫ power dt = Δ stored energy. Simpson's rule integrates over each step.
void audit(const erp::MotorType& m, const Run& run, MotorAudit& worst) {
  const double h = 2e-6;
  const sim::Motor motor(m, spindle_radius_m, h);
  const auto state_after = [&](const MotorState& x, double t) {
    return step(motor, x, run.voltage_V, run.tension_N, t);
  };
  MotorState x{0, run.speed_rad_per_s, 0};
  const double initial_stored_J = stored_J(m, x);
  Powers energies;
  for (int i = 0; i < 25000; ++i) {
    const MotorState end_state = state_after(x, h);
    Powers step_energies;
    step_energies.add(h / 6, powers(m, x, run));
    step_energies.add(h / 6 * 4, powers(m, state_after(x, h / 2), run));
    step_energies.add(h / 6, powers(m, end_state, run));
    worst.gearbox_generated_W =
        larger(worst.gearbox_generated_W, std::max(0.0, -step_energies.gear_W / h));
    energies.add(1, step_energies);
    x = end_state;
  }
  const double imbalance_J = energies.balance_W() - stored_J(m, x) + initial_stored_J;
  worst.balance_error =
      larger(worst.balance_error, std::abs(imbalance_J) / energies.sum_of_magnitudes_W());
}

}  // namespace

MotorAudit audit_motor(const erp::MotorType& type) {
  MotorAudit worst;
  // Chosen: wind up while driving and while braking, unwind while driving and while braking, slack
  // tendon, short circuit.
  for (const Run& run : {Run{2, 8, 60}, Run{6, -2, 60}, Run{-2, -9, 60}, Run{-6, 2, 90},
                         Run{3, -6, 0}, Run{-4, 0, 150}})
    audit(type, run, worst);
  return worst;
}

}  // namespace accuracy
