#pragma once
#include <vector>

#include "sim/gap/checks/means.hpp"

/// The robot's laws as straight lines, y = s x + rest, s about 1: by them signs, units and dead
/// columns of a recording are told before anything is fitted.
///
///   speed     ω against V/(K_E N)            current   i against (V − K_E N ω)/R
///   torque    N K_T i against r F + J ω̇, beside a friction that turns with ω
///   path      F/κ − r θ against L            spring    F against κ (L + r θ)
///
/// the former without F/κ where nobody measured F, and then only if L moves by more than the tendon may
/// have stretched; of means under a window (bump.hpp).
namespace sim::checks {

struct Line {
  double slope = 0, correlation = 0;
};

/// One law of one actuator, held against the means.
struct Law {
  enum class Kind { speed, current, torque, path, spring } kind;
  std::vector<Column> columns;  ///< the last one may as well be foretold by the others
  Signal foretold, measured;
  Line line;
  double widest = 3;  ///< times as much: few effects of a robot are as large; chosen
  /// A measure that is a third off, as effects are, would be more than all of it: a line wound up
  /// to pull harder, not to move a joint.
  bool small_difference = false;

  bool is_consistent() const;    ///< both sides go together
  bool is_inconclusive() const;  ///< both move, and neither good nor odd may be said of it
  bool near() const;             ///< they go the same way, about as far
  bool good() const { return is_consistent() && near(); }
  /// Against each other or far from equal; of a small difference only where nothing else is in it.
  bool suspicious() const;
};

class Laws {
 public:
  explicit Laws(const erp::Robot& robot) : robot_(robot), bones_(robot) {}

  /// Of rows `from` until before `until`.
  Means means(const Episode& episode, std::size_t from, std::size_t until);
  void find_paths(Means& means);
  /// The joints on which an actuator's path depends.
  std::vector<Column> crossed_by(std::size_t actuator) const;
  /// Those of one actuator whose columns the recording has.
  std::vector<Law> held_against(const Means& means, std::size_t actuator) const;

 private:
  void motor(std::size_t a, const Means& means, std::vector<Law>& laws) const;
  void torque(std::size_t a, const Means& means, std::vector<Law>& laws) const;
  /// By how much a pull that nobody measured may have changed, rms: by its motor's current, or all
  /// that the sensor's range would have.
  double swing_of_pull_N(std::size_t a, const Means& means) const;
  void tendon(std::size_t a, const Means& means, std::vector<Law>& laws) const;
  const erp::Robot& robot_;
  residuals::Skeletal bones_;
};

}  // namespace sim::checks
