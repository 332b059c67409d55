#pragma once
#include <functional>
#include <string>
#include <vector>

#include "sim/gap/estimation/remaining_residual.hpp"

/// Which effects of the library could explain what an estimate leaves:
///
///   score = what the cost loses along the effect's directions, the constants going along
///   step  = −G⁻¹ g     g = Dᵀ W z − (Jᵀ W D)ᵀ H⁻¹ ∇,   G = Dᵀ W D − (Jᵀ W D)ᵀ H⁻¹ (Jᵀ W D)
///
/// D: what the effect's parameters change in z; J, H and ∇: derivatives, Hessian and gradient of what is
/// estimated already (orthogonal least squares: Chen, Billings, Luo 1989). All stages and recordings
/// take part. Parameters that shape a law (speeds, time constants) are scanned; periods: periods.hpp.
namespace sim::estimation {

struct Candidate {
  effects::Placed start;  ///< with the values that would explain most
  double score = 0;
  Eigen::VectorXd others = {};  ///< how far the unknowns of the estimate go along then
};

struct Sensitivities;
struct Beginning;
struct StepBounds;

class Screen {
 public:
  /// All stay with the caller.
  Screen(const Estimator& train, const Uncertain& uncertain,
         const std::vector<std::string>& withhold)
      : train_(train), uncertain_(uncertain), withhold_(withhold) {}

  /// Best first; at most one a type and place, none that `base` has, none that changes no stage of `open`
  /// (one flag a stage; where none is set, all are).
  std::vector<Candidate> candidates(const Estimate& base, const std::vector<bool>& open) const;

 private:
  /// Not what a constant stands for already, and not what no residual shows.
  bool is_searched(const effects::About& about) const;
  Candidate best_shape(const Beginning& base, const effects::Placed& neutral) const;
  double cost_at(const Estimate& base, const RemainingResidual& left,
                 const Eigen::VectorXd& changed, const Eigen::VectorXd& moved) const;
  std::pair<double, Eigen::VectorXd> best_multiple(const Beginning& begin,
                                                   const Sensitivities& sensitivities,
                                                   const Eigen::MatrixXd& shared,
                                                   const Eigen::VectorXd& step,
                                                   const StepBounds& bounds) const;
  Candidate score(const Beginning& base, const Sensitivities& sensitivities) const;
  Candidate score_guess(const Beginning& base, const effects::Placed& guess,
                        const Eigen::VectorXd& changed) const;

  const Estimator& train_;
  const Uncertain& uncertain_;
  const std::vector<std::string>& withhold_;
};

}  // namespace sim::estimation
