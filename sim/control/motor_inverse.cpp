#include "sim/control/motor_inverse.hpp"

#include <cmath>

namespace sim {

double MotorInverse::current_A(double tension_N, double speed, double acceleration) const {
  const double n = motor_.gear_ratio;
  const auto turning = [&](double s) {
    const double output_Nm = radius_m_ * tension_N + motor_.gear_viscous_Nm_s_per_rad * speed +
                             s * motor_.gear_coulomb_Nm + motor_.gear_inertia_kg_m2 * acceleration;
    const double e = s * output_Nm >= 0 ? motor_.gear_efficiency : 1 / motor_.gear_efficiency;
    return (output_Nm / (e * n) + motor_.rotor_viscous_Nm_s_per_rad * n * speed +
            s * motor_.rotor_coulomb_Nm + motor_.rotor_inertia_kg_m2 * n * acceleration) /
           motor_.torque_Nm_per_A;
  };
  const double s = std::tanh(speed / creep_rad_per_s_);
  return 0.5 * ((1 + s) * turning(1) + (1 - s) * turning(-1));
}

}  // namespace sim
