#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "firmware/core/ecu.h"

/// A small plant for closed-loop tests: eq. 3 of the paper by Euler at 2 µs, on a spring that is fixed at
/// its other end; converters without noise. Published motor, the rig's friction and spring.
namespace firmware {

struct TinyMotor {
  static constexpr double R = 0.516, L = 57.3e-6, K = 11.5e-3, N = 128, eta = 0.59, r = 4.5e-3;
  static constexpr double J = 14.5e-7 * N * N * eta + 0.4e-7;
  static constexpr double mu = 1e-6 * N * N * eta + 5e-4, tau_c = N * eta * 0.3e-3 + 5e-3;
  static constexpr double kappa = 6000, supply_V = 12, pi = 3.14159265358979;

  double i_A = 0, w_rad_per_s = 0, shaft_rad = 0, peak_A = 0;

  double tension_N() const { return std::max(0.0, kappa * r * shaft_rad); }

  void step(double V, double dt_s) {
    const double drive_Nm = K * N * eta * i_A - r * tension_N() - mu * w_rad_per_s;
    const double sign =
        w_rad_per_s != 0 ? std::copysign(1, w_rad_per_s) : std::copysign(1, drive_Nm);
    const bool sticks = w_rad_per_s == 0 && std::abs(drive_Nm) <= tau_c;
    const double next = sticks ? 0 : w_rad_per_s + dt_s * (drive_Nm - sign * tau_c) / J;
    i_A += dt_s * (V - R * i_A - K * N * w_rad_per_s) / L;
    w_rad_per_s = next * w_rad_per_s < 0 ? 0 : next;  // stops before it turns
    shaft_rad += dt_s * w_rad_per_s;
    peak_A = std::max(peak_A, std::abs(i_A));
  }

  void period(std::int16_t duty) {
    for (int k = 0; k < 1000; ++k) step(supply_V * duty / ECU_DUTY_MAX, 2e-6);
  }

  ecu_inputs read() const {
    return {std::int32_t(std::lround(shaft_rad / (2 * pi) * 2048 * N)),
            std::int16_t(std::clamp(std::lround(i_A / 8 * 2048), -2048l, 2047l)),
            std::uint16_t(std::clamp(std::lround(tension_N() / 200 * 4095), 0l, 4095l))};
  }
};

}  // namespace firmware
