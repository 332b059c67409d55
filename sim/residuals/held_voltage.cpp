#include "sim/residuals/held_voltage.hpp"

#include <cmath>

namespace sim::residuals {
namespace {

/// While the voltage is held the speed settles, as e^(−t damping/inertia).
struct Settling {
  double inertia, damping;
  double share;  ///< ω_k − mean ω as a share of ω_k − ω_k−1
  double end;    ///< ω̇ at the period's end as a share of the mean ω̇
};

Settling settling(const erp::MotorType& m, double period_s) {
  const double n2 = m.gear_ratio * m.gear_ratio;
  const double inertia = m.rotor_inertia_kg_m2 * n2 + m.gear_inertia_kg_m2 / m.gear_efficiency;
  const double damping = n2 * m.torque_Nm_per_A * m.back_emf_V_s_per_rad / m.resistance_ohm;
  const double x = damping / inertia * period_s, left = std::exp(-x);
  if (x < 1e-6) return {inertia, damping, 0.5, 1};
  return {inertia, damping, ((1 - left) / x - left) / (1 - left), x * left / (1 - left)};
}

}  // namespace

double trail_s(const erp::MotorType& m, double period_s) {
  const double lag = m.inductance_H / m.resistance_ohm / period_s;
  return period_s * (lag - 1 / std::expm1(1 / lag));
}

double mean_speed_share(const erp::MotorType& m, double period_s) {
  return settling(m, period_s).share;
}

double earlier_share(const erp::MotorType& m, double period_s) {
  const Settling s = settling(m, period_s);
  return s.share - s.end * trail_s(m, period_s) / period_s;
}

double balance_inertia(const erp::MotorType& m, double period_s, double sampled) {
  const Settling s = settling(m, period_s);
  const double start_s = s.end * trail_s(m, period_s);
  return s.inertia - sampled * s.damping * (s.share * period_s - start_s);
}

}  // namespace sim::residuals
