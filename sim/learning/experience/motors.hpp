#pragma once
#include <vector>

#include "interfaces/values.hpp"
#include "sim/control/motor_inverse.hpp"
#include "sim/learning/experience/reach.hpp"

/// Converts muscle commands to ECU commands.
namespace sim::experience {

struct EcuReference {
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
  /// A voltage command is added to the voltage that holds the tension. The shaft then turns as fast
  /// as without load.
  EcuReference ecu_reference(std::size_t muscle, const MuscleCommand& command,
                             double tension_N) const {
    const double value = command.by_muscle[static_cast<Eigen::Index>(muscle)];
    if (command.lengths) return {erp::Mode::length, value};
    const Law& law = laws_[muscle];
    return {erp::Mode::voltage,
            law.inverse.voltage_V(tension_N, law.speed_rad_per_s_per_V * value, 0)};
  }

 private:
  static constexpr double creep_rad_per_s = 0.005;  // an offset of 1 mm commands 0.01 rad/s; chosen
  struct Law {
    MotorInverse inverse;
    double speed_rad_per_s_per_V;
  };
  std::vector<Law> laws_;
};

}  // namespace sim::experience
