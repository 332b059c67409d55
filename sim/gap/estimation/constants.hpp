#pragma once
#include <algorithm>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "sim/gap/residuals/stages.hpp"

/// The numbers of robot.xml that no two robots built to it share, each with its tolerance.
///
/// A number is estimated as x = (value − nominal)/tolerance, with the prior x ~ N(0, 1). Numbers that
/// robot.xml cannot hold (a sensor's gain, a moment arm, where something is zero) are written as
/// effects of the library.
namespace sim::estimation {

/// Standard deviation of a constant that is far off, in tolerances; chosen.
inline constexpr double usual_far = 20;

struct Constant {
  std::string
      name;  ///< "resistance_ohm", as in robot.xml; of a factor or a zero "moment_arm", "tension_zero_N"
  effects::Stage stage;
  std::string on;             ///< actuator, joint or body
  double nominal, tolerance;  ///< tolerance: one standard deviation, in the number's unit
  double lowest;              ///< no number below it makes sense; in the number's unit
  residuals::Reach reach;     ///< what it changes of an explanation
  std::function<void(erp::Robot&, double value)> set;
  std::string effect;       ///< the type of the library that is such a change
  double effect_scale = 1;  ///< of that effect's first parameter to value − nominal
  bool zero = false;        ///< where something is zero, not what it amounts to
  double far = usual_far;   ///< standard deviation where it is far off, in tolerances

  double highest =
      std::numeric_limits<double>::infinity();  ///< as `lowest`: what its effect can hold

  /// Its reciprocals add where several are in series, as springs: steps are even in 1/value.
  bool in_series = false;

  double value(double x) const { return std::clamp(nominal + tolerance * x, lowest, highest); }
  /// Where a step `by` leads to.
  double moved(double x, double by) const;
};

/// Those of a robot that recordings may determine, in the order of the chain: motor, gearbox,
/// spindle, tendon, routing and sensors of each actuator, then joints and bodies. A tendon that is a
/// rope, or a number that is 0 in robot.xml and has no default tolerance of its own, has none. Throws
/// xml::Errors where a <tolerance> of robot.xml names no such number.
std::vector<Constant> constants_of(const erp::Robot& robot);

/// The robot with the numbers nominal + tolerance·x.
erp::Robot with_constants(const erp::Robot& robot, std::span<const Constant> constants,
                          std::span<const double> x);

}  // namespace sim::estimation
