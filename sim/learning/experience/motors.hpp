#pragma once
#include <vector>

#include "interfaces/values.hpp"
#include "sim/control/motor_inverse.hpp"
#include "sim/learning/experience/reach.hpp"

/// From what muscles are asked to what their ECUs are asked.
namespace sim::experience {

struct Asked {
  erp::Mode mode = erp::Mode::off;
  double reference = 0;  ///< m or V
};

class Motors {
 public:
  explicit Motors(const erp::Robot& robot) {
    for (const erp::Actuator& a : robot.actuators)
      laws_.push_back(
          {MotorInverse(robot.motor_of(a), a.spindle.radius_m, creep_rad_per_s),
           1 / (robot.motor_of(a).back_emf_V_s_per_rad * robot.motor_of(a).gear_ratio)});
  }
  /// A voltage comes on top of what the tension takes: the shaft turns at the speed that it would
  /// have without load.
  Asked ask(std::size_t muscle, const Wanted& wanted, double tension_N) const {
    const double value = wanted.by_muscle[static_cast<Eigen::Index>(muscle)];
    if (wanted.lengths) return {erp::Mode::length, value};
    const Law& law = laws_[muscle];
    return {erp::Mode::voltage,
            law.inverse.voltage_V(tension_N, law.speed_rad_per_s_per_V * value, 0)};
  }

 private:
  static constexpr double creep_rad_per_s = 0.005;  // a millimetre of offset asks for 0.01; chosen
  struct Law {
    MotorInverse inverse;
    double speed_rad_per_s_per_V;
  };
  std::vector<Law> laws_;
};

}  // namespace sim::experience
