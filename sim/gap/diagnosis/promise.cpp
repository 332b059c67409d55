#include "sim/gap/diagnosis/promise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sim/gap/diagnosis/tries.hpp"
#include "sim/gap/estimation/can_show.hpp"
#include "sim/gap/residuals/indices.hpp"

namespace sim::diagnosis {
namespace {

using effects::Placed;
using Eigen::VectorXd;

/// z of one recording, 0 where nothing is judged.
class Look {
 public:
  Look(const Trials& trials, const Trial& base, std::vector<std::size_t> episodes)
      : trials_(trials), base_(base), only_(std::move(episodes)), left_(z_of(base)) {
    for (std::size_t e = 0; e < base.effects.size(); ++e) add_directions(e);
  }

  /// The best promise of the candidate's parameters and tries; 0: it changes nothing.
  double promise(const Placed& neutral) const {
    double best = 0;
    for (const Placed& nudged : nudges(neutral))
      best = std::max(best, along(z_of(trials_.with(base_, nudged, only_)) - left_));
    for (const Placed& one : tries(trials_, neutral, only_))
      best =
          std::max(best, left_.squaredNorm() - z_of(trials_.with(base_, one, only_)).squaredNorm());
    return best;
  }

 private:
  VectorXd z_of(const Trial& trial) const {
    std::vector<double> all;
    for (const std::size_t e : only_)
      for (const double z : trials_.whitened(trial, e)) all.push_back(std::isnan(z) ? 0 : z);
    return VectorXd::Map(all.data(), Eigen::Index(all.size()));
  }

  double along(VectorXd change) const {
    const double whole = change.squaredNorm();
    for (const VectorXd& d : directions_) change -= d.dot(change) * d;
    const double square = change.squaredNorm();
    constexpr double own = 1e-4;  // of its square: less is a copy of what is there
    if (square < 1e-12 || square < own * whole) return 0;
    return std::pow(left_.dot(change), 2) / square;
  }

  /// What the parameters of an effect of the base change, made orthonormal to the others.
  void add_directions(std::size_t e) {
    effects::AnyEffect counted = base_.effects[e].effect;
    const std::size_t count = effects::parameters(counted).size();
    for (std::size_t k = 0; k < count; ++k) {
      auto all = base_.effects;
      const auto parameter = effects::parameters(all[e].effect)[k];
      if (!parameter.fitted) continue;
      const double step = 1e-3 * (parameter.bounds.high - parameter.bounds.low);
      *parameter.value += *parameter.value + step > parameter.bounds.high ? -step : step;
      VectorXd d = z_of(trials_.with(all, only_)) - left_;
      for (const VectorXd& other : directions_) d -= other.dot(d) * other;
      if (d.norm() > 1e-9) directions_.push_back(d.normalized());
    }
  }

  const Trials& trials_;
  const Trial& base_;
  std::vector<std::size_t> only_;
  VectorXd left_;
  std::vector<VectorXd> directions_;
};

std::vector<double> promises(const Trials& trials, const Trial& base, const WhichOptions& options,
                             const std::vector<Placed>& all) {
  std::vector<double> promised(all.size());
  const bool drive =
      !trials.nominal().drives.empty();  // each of its recordings may be of one speed
  const Look look(trials, base,
                  drive ? options.train : std::vector{loudest(trials, base, options.train)});
  const auto found = map(options.pool, options.threads, all.size(),
                         [&](std::size_t k) { return Pool::Numbers{look.promise(all[k])}; });
  for (std::size_t k = 0; k < all.size(); ++k) promised[k] = found[k][0];
  return promised;
}

}  // namespace

std::vector<Placed> candidates(const Trials& trials, const std::vector<std::string>& withhold) {
  const bool estimated =
      std::ranges::any_of(trials.bare().of_episode,
                          [](const residuals::Explanation& e) { return e.joints->estimated; });
  const residuals::Stages nominal(trials.nominal());
  std::vector<Placed> all;
  for (const effects::AnyEffect& effect : effects::library()) {
    const effects::About& about = effects::about(effect);
    if (std::ranges::count(withhold, about.type)) continue;
    for (const std::string& on : effects::places(trials.nominal(), about.seat))
      if (const Placed placed{on, effect};
          estimation::can_show(placed, trials.nominal(), trials.episodes()) &&
          !(estimated && nominal.reach(placed).joints))
        all.push_back(placed);
  }
  return all;
}

std::vector<Placed> nudges(const Placed& neutral) {
  constexpr double little = 3e-3;
  std::vector<Placed> all;
  effects::AnyEffect counted = neutral.effect;
  const std::size_t count = effects::parameters(counted).size();
  for (std::size_t k = 0; k < count; ++k)
    for (const double share : {little, 0.1}) {
      Placed nudged = neutral;
      const auto parameters = effects::parameters(nudged.effect);
      if (!parameters[k].fitted) continue;
      for (std::size_t other = 0; other < k; ++other)
        *parameters[other].value += little * parameters[other].bounds.high;
      const auto& [low, high] = parameters[k].bounds;
      *parameters[k].value += share * (high > 0 ? high : low);
      all.push_back(std::move(nudged));
    }
  return all;
}

std::size_t loudest(const Trials& trials, const Trial& base,
                    std::span<const std::size_t> episodes) {
  return *std::ranges::max_element(episodes, {}, [&](std::size_t e) {
    const std::size_t only[] = {e};
    return sum(trials.blocks(base, only)).square;
  });
}

std::vector<Placed> promising(const Trials& trials, const Trial& base,
                              const WhichOptions& options) {
  const auto all = candidates(trials, options.withhold);
  const auto promised = promises(trials, base, options, all);
  auto sorted = promised;
  std::ranges::sort(sorted, std::greater());
  const double enough = std::min(options.look_share * sorted[0],
                                 sorted[std::min(options.fitted_at_least, sorted.size()) - 1]);
  std::vector<Placed> chosen;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (promised[k] > 0 && promised[k] >= enough) chosen.push_back(all[k]);
  return chosen;
}

std::vector<Placed> most_promising(const Trials& trials, const Trial& base,
                                   const WhichOptions& options, std::size_t count) {
  const auto all = candidates(trials, options.withhold);
  const auto promised = promises(trials, base, options, all);
  auto order = each(all.size());
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t k) { return promised[k]; });
  std::vector<Placed> chosen;
  for (std::size_t k = 0; k < std::min(count, all.size()) && promised[order[k]] > 0; ++k)
    chosen.push_back(all[order[k]]);
  return chosen;
}

}  // namespace sim::diagnosis
