#pragma once
#include <functional>
#include <vector>

#include "sim/gap/diagnosis/answer.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// Shapley values: the fraction of each of several causes in the gap that they jointly close.
///
///   v(S) = (S₀ − S_S)/(S₀ − N)                    gap closed by the subset S of the effects
///   φ_k  = mean of v(S + k) − v(S) over all orders in which the effects can be added      (Shapley 1953)
///
/// For more than six effects: φ_k = (v({k}) + v(all) − v(all but k))/2, which is equal if no three
/// effects interact. Σ φ_k = v(all). lost: v(all) − v(all but k); interaction: v(all) − Σ v({k}).
namespace sim::diagnosis {

struct ShapleyValues {
  std::vector<double> share;  ///< φ by effect
  std::vector<Interval> interval, lost;
  double interaction = 0;
};

/// Scores of the held-out recordings with the causes whose flag is set.
using BlocksOf = std::function<std::vector<ScoreBlock>(const std::vector<bool>& among)>;
ShapleyValues shapley_values(const Problem& problem, std::size_t count, const BlocksOf& blocks_of);
/// For effects on the robot of `evaluator`.
ShapleyValues shapley_values(const Problem& problem, const Evaluator& evaluator,
                             const std::vector<effects::Placed>& effect_set);

}  // namespace sim::diagnosis
