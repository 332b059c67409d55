#include "sim/gap/as_built.hpp"

#include <algorithm>
#include <cmath>

namespace sim::gap {
namespace {

constexpr double beyond = 2.5;  // tolerances; chosen
constexpr double widened = 10;  // tolerances: the prior of a constant beyond; chosen
constexpr double well = 0.75;   // determined: half its tolerance; chosen
constexpr std::size_t most_beyond = 12;

Uncertain uncertain_of(const erp::Robot& nominal, const std::vector<std::string>& withhold) {
  Uncertain u{nominal, constants_of(nominal), {}};
  std::erase_if(u.constants,
                [&](const Constant& c) { return std::ranges::count(withhold, c.effect) > 0; });
  u.prior.assign(u.constants.size(), 1.0);
  return u;
}

double determined(const Uncertain& u, const Estimate& e, std::size_t k) {
  return 1 - std::pow(e.sigma(k) / u.prior[k], 2);
}

/// The determined constant farthest beyond its tolerance whose prior is not wide yet.
std::optional<std::size_t> farthest(const Uncertain& u, const Estimate& e) {
  std::optional<std::size_t> far;
  for (std::size_t k = 0; k < u.constants.size(); ++k)
    if (u.prior[k] == 1 && std::abs(e.point.x[k]) > beyond && determined(u, e, k) > well)
      if (!far || std::abs(e.point.x[k]) > std::abs(e.point.x[*far])) far = k;
  return far;
}

/// A prior that holds one back makes others give way: the farthest is set free, then all are
/// estimated again.
void release(const Estimator& train, AsBuilt& built) {
  for (std::size_t n = 0; n < most_beyond; ++n) {
    const auto far = farthest(built.uncertain, built.estimate);
    if (!far) break;
    built.uncertain.prior[*far] = widened;
    built.estimate = train.run(built.uncertain, built.estimate.point);
  }
  built.beyond.clear();
  for (std::size_t k = 0; k < built.uncertain.constants.size(); ++k)
    if (std::abs(built.estimate.point.x[k]) > beyond &&
        determined(built.uncertain, built.estimate, k) > well)
      built.beyond.push_back(k);
  std::ranges::sort(built.beyond, std::greater(),
                    [&](std::size_t k) { return std::abs(built.estimate.point.x[k]); });
}

}  // namespace

double determined(const AsBuilt& built, std::size_t constant) {
  return determined(built.uncertain, built.estimate, constant);
}

AsBuilt calibrated(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                   const EstimateOptions& options) {
  const Estimator estimator(nominal, train, options);
  AsBuilt built{uncertain_of(nominal, {}), {}, {}, {}};
  built.estimate = estimator.run(built.uncertain, {});
  release(estimator, built);
  built.robot = robot_at(built.uncertain, built.estimate.point);
  return built;
}

AsBuilt as_built(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                 std::span<const residuals::Episode> held_out, const AsBuiltOptions& options) {
  const Estimator estimator(nominal, train, options.estimate);
  const ResidualVector judged(nominal, held_out, options.estimate.seed, options.estimate.threads);
  AsBuilt built{uncertain_of(nominal, options.search.withhold), {}, {}, {}};
  const Search search(estimator, judged, built.uncertain, options.search);
  built.estimate = estimator.run(built.uncertain, {});
  release(estimator, built);
  built.estimate = search.run(built.estimate).train;
  release(estimator, built);
  built.robot = robot_at(built.uncertain, built.estimate.point);
  return built;
}

}  // namespace sim::gap
