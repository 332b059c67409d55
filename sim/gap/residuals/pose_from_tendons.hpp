#pragma once
#include <functional>
#include <span>
#include <vector>

#include "sim/gap/residuals/chain_trace.hpp"

/// Joints that nobody measured, from the tendons: the pose in which every line pulls as it was
/// measured to pull.
///
///   min_q Σ_a (F_a − F̂_a(L_a(q), θ_a))²      F̂ the tendon's law with the robot's effects
///
/// by Gauss and Newton, all rows at once. The damper couples rows: a step is that of a spring and a
/// damper, κ δ + D δ̇, or rows would swing ever more. The pose is smoothed, for the law's damper would
/// answer to its noise. Slack tendons say nothing. What is left of the tendons' stages are their
/// contradictions, fewer than there are tendons.
namespace sim::residuals {

/// The chains of all tendons that say shaft and tension, under some joint signals.
using Chains = std::function<std::vector<ChainTrace>(const std::vector<JointSignals>&)>;

class PoseSearch {
 public:
  /// `missing`: joints to be found; `damper_s`: D/κ of the lines.
  PoseSearch(const std::vector<erp::Joint>& joints, std::vector<std::size_t> missing, Chains chains,
             double period_s, double damper_s);

  /// Degrees of freedom to be found.
  std::size_t unknowns() const { return unknown_.size(); }
  /// Where the robot starts, throughout.
  void start(std::vector<JointSignals>& signals, std::size_t rows) const;
  /// Betters the missing joints' signals by some steps, with slopes taken anew every so many; NaN
  /// where the tendons do not hold them.
  void better(std::vector<JointSignals>& signals, int steps, int slopes_every) const;

 private:
  struct Unknown {
    std::size_t joint;
    int axis;
  };
  void turn(std::vector<JointSignals>& signals, const Unknown& unknown, std::size_t row,
            double rad) const;
  /// How the pulls answer to each unknown, N/rad: a column a row of the recording, in it lines ×
  /// unknowns; 0: slack, or not known.
  Eigen::MatrixXd slopes(const std::vector<JointSignals>& signals,
                         const std::vector<ChainTrace>& here) const;
  template <class Change>
  void change(std::vector<JointSignals>& signals, Change each) const;

  const std::vector<erp::Joint>& joints_;
  std::vector<std::size_t> missing_;
  Chains chains_;
  double period_s_, damper_s_;
  std::vector<Unknown> unknown_;
};

}  // namespace sim::residuals
