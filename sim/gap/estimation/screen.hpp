#pragma once
#include <functional>
#include <string>
#include <vector>

#include "sim/gap/estimation/remaining_residual.hpp"

/// Scores the effects of the library that could explain the remaining residual of an estimate:
///
///   score = decrease of the cost by the step of the effect's parameters, with the response of the constants
///   step  = −G⁻¹ g     g = Dᵀ W z − (Jᵀ W D)ᵀ H⁻¹ ∇,   G = Dᵀ W D − (Jᵀ W D)ᵀ H⁻¹ (Jᵀ W D)
///
/// D: ∂z/∂(parameters of the effect); J, H and ∇: derivatives, Hessian and gradient of the unknowns
/// that are already estimated (orthogonal least squares: Chen, Billings, Luo 1989). All stages and
/// recordings are used. Parameters that shape a law (speeds, time constants) are scanned; periods:
/// periods.hpp.
namespace sim::estimation {

struct Candidate {
  effects::Placed start;  ///< with the values of highest score
  double score = 0;
  Eigen::VectorXd others = {};  ///< step of the unknowns of the estimate in response to the effect
};

struct Sensitivities;
struct Basis;
struct StepBounds;

class Screen {
 public:
  /// All arguments must outlive the screen.
  Screen(const Estimator& train, const Uncertain& uncertain,
         const std::vector<std::string>& withhold)
      : train_(train), uncertain_(uncertain), withhold_(withhold) {}

  /// Returns the candidates with positive scores, the best first, at most one for each type and
  /// place. Effects that `base` has are omitted, and effects that change no open stage. `open`: one
  /// flag per stage; if no flag is set, all stages are open.
  std::vector<Candidate> candidates(const Estimate& base, const std::vector<bool>& open) const;

 private:
  /// False for withheld effects, for effects that a constant represents, and for effects that no
  /// residual can show.
  bool is_searched(const effects::About& about) const;
  Candidate best_shape(const Basis& base, const effects::Placed& neutral) const;
  double cost_at(const Estimate& base, const RemainingResidual& remaining,
                 const Eigen::VectorXd& changed, const Eigen::VectorXd& moved) const;
  std::pair<double, Eigen::VectorXd> best_multiple(const Basis& basis,
                                                   const Sensitivities& sensitivities,
                                                   const Eigen::MatrixXd& shared,
                                                   const Eigen::VectorXd& step,
                                                   const StepBounds& bounds) const;
  Candidate score(const Basis& base, const Sensitivities& sensitivities) const;
  Candidate score_guess(const Basis& base, const effects::Placed& guess,
                        const Eigen::VectorXd& changed) const;

  const Estimator& train_;
  const Uncertain& uncertain_;
  const std::vector<std::string>& withhold_;
};

}  // namespace sim::estimation
