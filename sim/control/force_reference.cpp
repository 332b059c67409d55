#include "sim/control/force_reference.hpp"

#include <algorithm>

#include "sim/control/gain_design.hpp"

namespace sim {

ForceReference::ForceReference(const erp::Robot& robot, const erp::Actuator& actuator)
    : motor_(robot.motor_of(actuator), actuator.spindle.radius_m),
      spring_(Spring::of(actuator.tendon)) {
  const EcuParameters p = design_parameters(robot, actuator, {});
  const double prefilter = p[ECU_PARAMETER_FORCE_PREFILTER];
  per_A_ = (p[ECU_PARAMETER_RESISTANCE] + p[ECU_PARAMETER_FORCE_K_CURRENT]) / prefilter;
  per_speed_ = (p[ECU_PARAMETER_BACK_EMF] + p[ECU_PARAMETER_FORCE_K_SPEED]) / prefilter;
  per_N_ = p[ECU_PARAMETER_FORCE_K_TENSION] / prefilter;
}

double ForceReference::reference_N(const TendonMotion& m) const {
  const double f = std::max(0.0, m.tension_N);
  const double slope = spring_.slope_N_per_m(spring_.stretch_m(f));
  const double speed = (m.tension_rate_N_per_s / slope - m.length_rate_m_per_s) / motor_.radius_m();
  const double acceleration = -m.length_acceleration_m_per_s2 / motor_.radius_m();
  return per_A_ * motor_.current_A(f, speed, acceleration) + per_speed_ * speed + per_N_ * f;
}

}  // namespace sim
