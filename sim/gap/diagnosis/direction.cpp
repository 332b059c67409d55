#include "sim/gap/diagnosis/direction.hpp"

#include <Eigen/QR>
#include <cmath>
#include <span>

#include "sim/gap/diagnosis/promise.hpp"
#include "interfaces/parallel/in_parallel.hpp"
#include "sim/gap/residuals/indices.hpp"

namespace sim::diagnosis {
namespace {

using effects::Placed;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// z of all recordings, 0 where nothing is judged.
VectorXd z_of(const Trials& trials, const Trial& trial) {
  std::vector<double> all;
  for (std::size_t e = 0; e < trials.episodes().size(); ++e)
    for (const double z : trials.whitened(trial, e)) all.push_back(std::isnan(z) ? 0 : z);
  return Eigen::Map<VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

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

std::vector<Direction> directions(const Trials& trials, const std::vector<std::string>& withhold,
                                  int threads) {
  const VectorXd bare = z_of(trials, trials.bare());
  const auto all = candidates(trials, withhold);
  std::vector<Direction> directions(all.size());
  in_parallel(all.size(), threads,
              [&](std::size_t k) { directions[k] = direction_of(trials, bare, all[k]); });
  return directions;
}

}  // namespace sim::diagnosis
