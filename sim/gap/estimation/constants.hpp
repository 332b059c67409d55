#pragma once
#include <algorithm>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "sim/gap/residuals/stages.hpp"

/// The numbers of robot.xml that differ from robot to robot, each with its tolerance.
///
/// A number is estimated as x = (value − nominal)/tolerance, with the prior x ~ N(0, 1). Numbers that robot.xml has no
/// attribute for (a sensor's gain, a moment arm, a zero) are represented as effects of the library.
namespace sim::estimation {

/// Standard deviation of a constant that is far off, in tolerances; chosen.
inline constexpr double default_far = 20;

struct Constant {
  std::string
      name;  ///< as in robot.xml: "resistance_ohm"; a factor or zero: "moment_arm", "tension_zero_N"
  effects::Stage stage;
  std::string on;             ///< actuator, joint or body
  double nominal, tolerance;  ///< tolerance: one standard deviation, in the number's unit
  double lowest;              ///< lower bound, in the number's unit
  residuals::Reach reach;     ///< the parts of an explanation that it changes
  std::function<void(erp::Robot&, double value)> set;
  std::string effect;        ///< the type of the library that represents such a change
  double effect_scale = 1;   ///< that effect's first parameter / (value − nominal)
  bool zero = false;         ///< it is a zero (offset), not a magnitude
  double far = default_far;  ///< standard deviation if it is far off, in tolerances

  double highest = std::numeric_limits<double>::infinity();  ///< upper bound, of its effect

  /// True for stiffnesses: their reciprocals add in series, so steps are uniform in 1/value.
  bool in_series = false;

  double value(double x) const { return std::clamp(nominal + tolerance * x, lowest, highest); }
  /// x after a step `by`.
  double moved(double x, double by) const;
};

/// The constants of a robot that recordings may determine, in the order of the chain: motor, gearbox, spindle, tendon,
/// routing and sensors of each actuator, then joints and bodies. Not included: tendons that are ropes, and numbers that
/// are 0 in robot.xml without an absolute default tolerance. Throws xml::Errors if a `<tolerance>` of robot.xml names no
/// such number.
std::vector<Constant> constants_of(const erp::Robot& robot);

/// The robot with the numbers nominal + tolerance·x.
erp::Robot with_constants(const erp::Robot& robot, std::span<const Constant> constants,
                          std::span<const double> x);

}  // namespace sim::estimation
