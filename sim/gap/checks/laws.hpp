#pragma once
#include <vector>

#include "sim/gap/checks/means.hpp"

/// The robot's laws as straight lines, y = s x + remainder. The slope s of a correct recording is
/// near 1. The laws reveal wrong signs, wrong units and dead columns before anything is fitted.
///
///   law       y                      x
///   speed     ω                      V/(K_E N)
///   current   i                      (V − K_E N ω)/R
///   torque    N K_T i                r F + J ω̇, after a regression of both sides on sgn ω (friction)
///   path      F/κ − r θ              L
///   spring    F                      κ (L + r θ)
///
/// V, i: voltage and current; θ, ω: angle and speed of the gearbox shaft; N: gear ratio; J:
/// inertia; r: radius of the spindle; F, κ, L: tension, stiffness and path length of the tendon.
/// Without a measured F, the path law omits F/κ; it is then used only if L changes by more than the
/// tendon can stretch. All signals are means under a window (bump.hpp).
namespace sim::checks {

struct Line {
  double slope = 0, correlation = 0;
};

/// One law of one actuator, evaluated on the means.
struct Law {
  enum class Kind { speed, current, torque, path, spring } kind;
  std::vector<Column> columns;  ///< the other columns determine the last one
  Signal predicted, measured;
  Line line;
  double largest_slope = 3;  ///< few effects of a robot change a slope by a larger factor; chosen
  /// The measured side is a small difference of large terms. An effect that changes one term by a
  /// third can change the difference by more than its value. Example: a motor winds a tendon up to
  /// raise the tension without motion.
  bool small_difference = false;

  bool is_consistent() const;  ///< both sides are correlated
  /// Both sides change, but the law is neither satisfied nor suspicious.
  bool is_inconclusive() const;
  bool has_plausible_slope() const;  ///< positive, and within a factor `largest_slope` of 1
  bool is_satisfied() const { return is_consistent() && has_plausible_slope(); }
  /// Correlated with an implausible slope. With a small difference, a higher correlation is
  /// required.
  bool is_suspicious() const;
};

class Laws {
 public:
  explicit Laws(const erp::Robot& robot) : robot_(robot), bones_(robot) {}

  /// Means of the rows `first` … `end` − 1, with the tendon paths.
  Means means(const Episode& episode, std::size_t first, std::size_t end);
  void compute_paths(Means& means);
  /// Angle columns of the joints that an actuator's tendon crosses.
  std::vector<Column> crossed_by(std::size_t actuator) const;
  /// Evaluates the laws of one actuator. Laws whose columns are not recorded are omitted.
  std::vector<Law> evaluate(const Means& means, std::size_t actuator) const;

 private:
  void add_motor_laws(std::size_t a, const Means& means, std::vector<Law>& laws) const;
  void add_torque_law(std::size_t a, const Means& means, std::vector<Law>& laws) const;
  /// Possible variation of an unmeasured tension, rms: from the motor's current or, without a
  /// current, half the sensor's range.
  double tension_variation_N(std::size_t a, const Means& means) const;
  void add_tendon_laws(std::size_t a, const Means& means, std::vector<Law>& laws) const;
  const erp::Robot& robot_;
  residuals::Skeletal bones_;
};

}  // namespace sim::checks
