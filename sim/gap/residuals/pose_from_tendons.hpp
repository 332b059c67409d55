#pragma once
#include <functional>
#include <span>
#include <vector>

#include "sim/gap/residuals/chain_trace.hpp"

/// Estimates the angles of unmeasured joints: the pose in which the tendons' law gives the measured
/// tensions.
///
///   min_q Σ_a (F_a − F̂_a(L_a(q), θ_a))²      F̂: the tendon's law with the robot's effects
///
/// by Gauss-Newton steps of all rows. A step δ is computed with spring and damper, κ δ + D δ̇,
/// because the damper couples successive rows; otherwise the rows would oscillate. The pose is
/// smoothed because the damper of the law amplifies its noise. Slack tendons are not used. The
/// tendon stages then contain only the contradictions between tendons; their number is the number
/// of tendons minus that of the unknowns.
namespace sim::residuals {

/// Computes the chains of all tendons with measured shaft and tension, for given joint signals.
using Chains = std::function<std::vector<ChainTrace>(const std::vector<JointSignals>&)>;

class PoseSearch {
 public:
  /// `missing`: joints to estimate; `damper_s`: D/κ of the tendons.
  PoseSearch(const std::vector<erp::Joint>& joints, std::vector<std::size_t> missing, Chains chains,
             double period_s, double damper_s);

  /// Number of unknown coordinates.
  std::size_t unknowns() const { return unknown_.size(); }
  /// Sets the missing joints to the initial pose in all rows.
  void start(std::vector<JointSignals>& signals, std::size_t rows) const;
  /// Improves the missing joints' signals by Gauss-Newton steps. The slopes are recomputed every
  /// `slopes_every` steps. Sets NaN where the tendons do not determine the pose.
  void refine(std::vector<JointSignals>& signals, int steps, int slopes_every) const;

 private:
  struct Unknown {
    std::size_t joint;
    int axis;
  };
  void turn(std::vector<JointSignals>& signals, const Unknown& unknown, std::size_t row,
            double rad) const;
  /// ∂F̂/∂q in N/rad: one column of tendons × unknowns for each row of the recording; 0: slack, or
  /// not available.
  Eigen::MatrixXd slopes(const std::vector<JointSignals>& signals,
                         const std::vector<ChainTrace>& chains) const;
  template <class Change>
  void change_missing(std::vector<JointSignals>& signals, Change each) const;

  const std::vector<erp::Joint>& joints_;
  std::vector<std::size_t> missing_;
  Chains chains_;
  double period_s_, damper_s_;
  std::vector<Unknown> unknown_;
};

}  // namespace sim::residuals
