#pragma once
#include <functional>
#include <vector>

#include "sim/gap/diagnosis/answer.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// What each of several causes has to do with the gap that they close together.
///
///   v(S) = (S₀ − S_S)/(S₀ − N)                       closed by the subset S of the effects
///   φ_k  = mean over all orders of joining of v(S + k) − v(S)                (Shapley 1953)
///
/// Of more than six, whose subsets are too many, (v({k}) + v(all) − v(all but k))/2, which is the same
/// where no three interact. Their sum is what all close; lost: v(all) − v(all but k); interaction: v(all) − Σ v({k}).
namespace sim::diagnosis {

struct ShapleyValues {
  std::vector<double> share;  ///< φ, one an effect
  std::vector<Interval> interval, lost;
  double interaction = 0;
};

/// What the recordings held out score with some causes, a flag each.
using BlocksOf = std::function<std::vector<ScoreBlock>(const std::vector<bool>& among)>;
ShapleyValues shapley_values(const Problem& problem, std::size_t count, const BlocksOf& blocks_of);
/// Of effects on the robot of `trials`.
ShapleyValues shapley_values(const Problem& problem, const Evaluator& evaluator,
                             const std::vector<effects::Placed>& together);

}  // namespace sim::diagnosis
