#include "sim/actuator/force_reference.hpp"

#include <algorithm>
#include <cmath>

#include "sim/actuator/design.hpp"

namespace sim {

ForceReference::ForceReference(const erp::Robot& robot, const erp::Actuator& actuator)
    : motor_(robot.motor_of(actuator)),
      spring_(Spring::of(actuator.tendon)),
      radius_m_(actuator.spindle.radius_m) {
  const EcuParameters p = design_parameters(robot, actuator, {});
  const double prefilter = p[ECU_PARAMETER_FORCE_PREFILTER];
  per_A_ = (motor_.resistance_ohm + p[ECU_PARAMETER_FORCE_K_CURRENT]) / prefilter;
  per_speed_ = (p[ECU_PARAMETER_BACK_EMF] + p[ECU_PARAMETER_FORCE_K_SPEED]) / prefilter;
  per_N_ = p[ECU_PARAMETER_FORCE_K_TENSION] / prefilter;
}

double ForceReference::reference_N(const TendonMotion& m) const {
  const double f = std::max(0.0, m.tension_N);
  const double slope = spring_.slope_N_per_m(spring_.stretch_m(f));
  const double speed = (m.tension_rate_N_per_s / slope - m.length_rate_m_per_s) / radius_m_;
  const double acceleration = -m.length_acceleration_m_per_s2 / radius_m_;
  return per_A_ * current_A(f, speed, acceleration) + per_speed_ * speed + per_N_ * f;
}

double ForceReference::current_A(double tension_N, double speed, double acceleration) const {
  const double n = motor_.gear_ratio;
  const auto turning = [&](double s) {
    const double output_Nm = radius_m_ * tension_N + motor_.gear_viscous_Nm_s_per_rad * speed +
                             s * motor_.gear_coulomb_Nm + motor_.gear_inertia_kg_m2 * acceleration;
    const double e = s * output_Nm >= 0 ? motor_.gear_efficiency : 1 / motor_.gear_efficiency;
    return (output_Nm / (e * n) + motor_.rotor_viscous_Nm_s_per_rad * n * speed +
            s * motor_.rotor_coulomb_Nm + motor_.rotor_inertia_kg_m2 * n * acceleration) /
           motor_.torque_Nm_per_A;
  };
  const double s = std::tanh(speed / creep_rad_per_s);
  return 0.5 * ((1 + s) * turning(1) + (1 - s) * turning(-1));
}

}  // namespace sim
