#pragma once
#include <cmath>

#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// The winding's resistance increases with its temperature.
///
///   R' = R (1 + α ΔT),   d ΔT/dt = (R' ⟨i²⟩ R_th − ΔT) / T_th,   α = 0.00393 1/K (copper)
///
/// Ignores the temperature dependence of the magnet.
/// Source: maxon motor data sheets, thermal data; IEC 60034-1 for α.
struct MotorThermalResistance {
  static constexpr About about{"motor_thermal_resistance", Stage::motor, Seat::actuator,
                               "high current for longer than a minute, then low"};

  double kelvin_per_W = 0;      // R_th
  double time_constant_s = 20;  // T_th

  void visit(auto& v) {
    v("kelvin_per_W", kelvin_per_W, Bounds{0, 1e4});
    v.shape("time_constant_s", time_constant_s, Bounds{1, 1000});
  }
  double resistance_ohm(double cold_ohm, const ChainSample& s, Memory& memory) const {
    constexpr double copper_per_K = 0.00393;
    double& rise_K = memory[0];
    const double now_ohm = cold_ohm * (1 + copper_per_K * rise_K);
    const double heat_W = now_ohm * s.current_square_A2;
    rise_K += (heat_W * kelvin_per_W - rise_K) * -std::expm1(-s.dt_s / time_constant_s);
    return now_ohm;
  }
};

}  // namespace sim::effects
