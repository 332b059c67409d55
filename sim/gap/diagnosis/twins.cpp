#include "sim/gap/diagnosis/twins.hpp"

#include <algorithm>

#include "sim/gap/diagnosis/direction.hpp"

namespace sim::diagnosis {

std::vector<Twin> twins(const Trials& trials, double share,
                        const std::vector<std::string>& withhold, int threads) {
  const auto all = directions(trials, withhold, threads);
  std::vector<Twin> twins;
  for (const Direction& hidden : all)
    for (const Direction& other : all) {
      if (&hidden == &other || hidden.first.norm() < shown || other.span.cols() == 0) continue;
      const Eigen::VectorXd left =
          hidden.first - other.span * (other.span.transpose() * hidden.first);
      if (left.norm() <= share * hidden.first.norm())
        twins.push_back({hidden.nudged, {other.nudged}, hidden.first.norm(), left.norm()});
    }
  std::ranges::stable_sort(twins, {}, [](const Twin& t) { return t.left / t.shows; });
  return twins;
}

}  // namespace sim::diagnosis
