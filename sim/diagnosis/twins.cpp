#include "sim/diagnosis/twins.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>

#include "sim/diagnosis/promise.hpp"
#include "sim/parallel/in_parallel.hpp"
#include "sim/residuals/indices.hpp"

namespace sim::diagnosis {
namespace {

using effects::Placed;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double shown = 1;  // standard deviation: less is not seen at all

/// z of all recordings, 0 where nothing is judged.
VectorXd z_of(const Trials& trials, const Trial& trial) {
  std::vector<double> all;
  for (std::size_t e = 0; e < trials.episodes().size(); ++e)
    for (const double z : trials.whitened(trial, e)) all.push_back(std::isnan(z) ? 0 : z);
  return Eigen::Map<VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

/// What an effect changes.
struct Direction {
  Placed nudged;
  VectorXd first;  ///< by its first parameter
  MatrixXd span;   ///< by all of them, orthonormal
};

Direction direction_of(const Trials& trials, const VectorXd& bare, const Placed& neutral) {
  const auto all = each(trials.episodes().size());
  const auto ways = nudges(neutral);  // a little and more, of each parameter
  MatrixXd changes(bare.size(), static_cast<Eigen::Index>(ways.size()) / 2);
  Direction direction;
  for (Eigen::Index k = 0; k < changes.cols(); ++k)
    for (const Placed& way : std::span(ways).subspan(std::size_t(2 * k), 2)) {
      changes.col(k) = z_of(trials, trials.with(trials.bare(), way, all)) - bare;
      if (k == 0) direction.nudged = way;
      if (changes.col(k).norm() > shown) break;
    }
  const Eigen::ColPivHouseholderQR<MatrixXd> parts(changes);
  direction.first = changes.col(0);
  direction.span = parts.householderQ() * MatrixXd::Identity(bare.size(), parts.rank());
  return direction;
}

}  // namespace

std::vector<Twin> twins(const Trials& trials, double share, int threads) {
  const VectorXd bare = z_of(trials, trials.bare());
  const auto all = candidates(trials, {});
  std::vector<Direction> directions(all.size());
  in_parallel(all.size(), threads,
              [&](std::size_t k) { directions[k] = direction_of(trials, bare, all[k]); });
  std::vector<Twin> twins;
  for (const Direction& hidden : directions)
    for (const Direction& other : directions) {
      if (&hidden == &other || hidden.first.norm() < shown || other.span.cols() == 0) continue;
      const VectorXd left = hidden.first - other.span * (other.span.transpose() * hidden.first);
      if (left.norm() <= share * hidden.first.norm())
        twins.push_back({hidden.nudged, other.nudged, hidden.first.norm(), left.norm()});
    }
  std::ranges::stable_sort(twins, {}, [](const Twin& t) { return t.left / t.shows; });
  return twins;
}

}  // namespace sim::diagnosis
