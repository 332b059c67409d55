#include "sim/gap/diagnosis/indistinguishable.hpp"

#include <algorithm>

#include "sim/gap/diagnosis/sensitivity.hpp"

namespace sim::diagnosis {

std::vector<Indistinguishable> indistinguishable_effects(const Evaluator& evaluator, double share,
                                                         const std::vector<std::string>& withhold,
                                                         int threads) {
  const auto all = sensitivities(evaluator, withhold, threads);
  std::vector<Indistinguishable> found;
  for (const Sensitivity& hidden : all)
    for (const Sensitivity& other : all) {
      if (&hidden == &other || hidden.first.norm() < visible_change || other.span.cols() == 0)
        continue;
      const Eigen::VectorXd remaining =
          hidden.first - other.span * (other.span.transpose() * hidden.first);
      if (remaining.norm() <= share * hidden.first.norm())
        found.push_back(
            {hidden.perturbed, {other.perturbed}, hidden.first.norm(), remaining.norm()});
    }
  std::ranges::stable_sort(found, {},
                           [](const Indistinguishable& t) { return t.remaining / t.magnitude; });
  return found;
}

}  // namespace sim::diagnosis
