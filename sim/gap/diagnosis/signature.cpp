#include "sim/gap/diagnosis/signature.hpp"

#include <algorithm>
#include <cmath>

namespace sim::diagnosis {
namespace {

struct Change {
  std::vector<double> z;          ///< of every window
  std::vector<double> square_at;  ///< Σ by stage
  double square = 0;
};

Change change_of(const Problem& problem, const Evaluator& evaluator,
                 const std::vector<StageGap>& stages, const Evaluation& with) {
  Change change{{}, std::vector<double>(stages.size(), 0.0)};
  for (const std::size_t e : problem.sets.held_out) {
    const auto before = evaluator.whitened(evaluator.bare(), e),
               after = evaluator.whitened(with, e);
    std::size_t at = 0;
    for (const residuals::Residual& r : evaluator.bare().of_episode[e].residuals) {
      const auto stage = std::size_t(find_stage(stages, r.stage, r.on) - stages.begin());
      for (std::size_t n = 0; n < r.value.size(); ++n, ++at) {
        const double d = std::isnan(before[at]) ? 0 : after[at] - before[at];
        change.z.push_back(d), change.square += d * d;
        change.square_at[stage] += d * d;
      }
    }
  }
  return change;
}

}  // namespace

void compute_signatures(const Problem& problem, const Evaluator& evaluator,
                        const std::vector<StageGap>& stages, std::vector<Ranked>& ranked,
                        std::vector<IdentifiedEffect>& names) {
  Change first;
  for (std::size_t k = 0; k < ranked.size(); ++k) {
    Change change = change_of(problem, evaluator, stages, ranked[k].on_held_out);
    ranked[k].on_held_out = {};
    if (k == 0) first = change;
    double dot = 0;
    for (std::size_t n = 0; n < first.z.size(); ++n) dot += first.z[n] * change.z[n];
    names[k].likeness = dot / std::max(std::sqrt(first.square * change.square), 1e-12);
    for (double& s : change.square_at) s /= std::max(change.square, 1e-12);
    names[k].signature = std::move(change.square_at);
  }
}

}  // namespace sim::diagnosis
