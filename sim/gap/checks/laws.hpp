#pragma once
#include <vector>

#include "sim/gap/checks/means.hpp"

/// The robot's laws as straight lines, y = s x + remainder with s near 1. They reveal wrong signs, wrong units and dead
/// columns of a recording before anything is fitted.
///
///   speed     ω over V/(K_E N)            current   i over (V − K_E N ω)/R
///   torque    N K_T i over r F + J ω̇, with a friction of the sign of ω regressed out
///   path      F/κ − r θ over L            spring    F over κ (L + r θ)
///
/// Without a measured F, the path law omits F/κ, and is used only if L changes by more than the tendon may have
/// stretched. All signals are means under a window (bump.hpp).
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
  /// The measured side is a small difference of large terms: an error of a third of one term, as effects cause it,
  /// would exceed it. Example: a tendon that is wound up to raise its tension, not to move a joint.
  bool small_difference = false;

  bool is_consistent() const;  ///< both sides are correlated
  bool is_inconclusive()
      const;  ///< both sides change, but the law is neither satisfied nor suspicious
  bool has_plausible_slope() const;  ///< positive, and within a factor `largest_slope` of 1
  bool is_satisfied() const { return is_consistent() && has_plausible_slope(); }
  /// Correlated with an implausible slope. With a small difference, a higher correlation is required.
  bool suspicious() const;
};

class Laws {
 public:
  explicit Laws(const erp::Robot& robot) : robot_(robot), bones_(robot) {}

  /// Of the rows `from` … `until` − 1.
  Means means(const Episode& episode, std::size_t from, std::size_t until);
  void compute_paths(Means& means);
  /// The joints on which an actuator's path depends.
  std::vector<Column> crossed_by(std::size_t actuator) const;
  /// The laws of one actuator for which the recording has the columns.
  std::vector<Law> evaluate(const Means& means, std::size_t actuator) const;

 private:
  void motor(std::size_t a, const Means& means, std::vector<Law>& laws) const;
  void torque(std::size_t a, const Means& means, std::vector<Law>& laws) const;
  /// By how much an unmeasured tension may have varied, rms: as its motor's current implies or, without a current,
  /// half the sensor's range.
  double tension_variation_N(std::size_t a, const Means& means) const;
  void tendon(std::size_t a, const Means& means, std::vector<Law>& laws) const;
  const erp::Robot& robot_;
  residuals::Skeletal bones_;
};

}  // namespace sim::checks
