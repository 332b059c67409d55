#pragma once
#include <algorithm>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "sim/gap/residuals/stages.hpp"

/// The numbers of robot.xml that differ between robots of one design, each with its tolerance.
///
/// A number is estimated as x = (value − nominal)/tolerance, with the prior x ~ N(0, 1). Numbers
/// without an attribute in robot.xml (a sensor's gain, a moment arm, a zero) are represented as
/// effects of the library.
namespace sim::estimation {

/// Standard deviation of a constant that is far off, in tolerances; chosen.
inline constexpr double default_far_sigma = 20;

struct Constant {
  /// As in robot.xml, "resistance_ohm"; for a factor or a zero: "moment_arm", "tension_zero_N".
  std::string name;
  effects::Stage stage;
  std::string on;             ///< actuator, joint or body
  double nominal, tolerance;  ///< tolerance: one standard deviation, in the number's unit
  double lowest;              ///< lower bound, in the number's unit
  residuals::Reach reach;     ///< the parts of an explanation that it changes
  std::function<void(erp::Robot&, double value)> set;
  std::string effect;  ///< type of the library's effect that represents a change of the constant
  double effect_scale = 1;               ///< first parameter of this effect / (value − nominal)
  bool zero = false;                     ///< whether it is a zero (offset) of a sensor or a line
  double far_sigma = default_far_sigma;  ///< standard deviation if it is far off, in tolerances

  double highest = std::numeric_limits<double>::infinity();  ///< upper bound, in the number's unit

  /// True for stiffnesses. Steps are uniform in 1/value because the reciprocals of stiffnesses in
  /// series add.
  bool in_series = false;

  double value(double x) const { return std::clamp(nominal + tolerance * x, lowest, highest); }
  /// Returns x after a step.
  double moved(double x, double step) const;
};

/// Returns the constants of a robot that recordings may determine: motor, gearbox, spindle, tendon,
/// routing and sensors of each actuator, then joints and bodies. Tendons that are ropes are
/// excluded, and numbers that are 0 in robot.xml without an absolute default tolerance. Throws
/// xml::Errors if a `<tolerance>` of robot.xml names none of the numbers.
std::vector<Constant> constants_of(const erp::Robot& robot);

/// Returns the robot with the numbers nominal + tolerance·x.
erp::Robot with_constants(const erp::Robot& robot, std::span<const Constant> constants,
                          std::span<const double> x);

}  // namespace sim::estimation
