#include "sim/diagnosis/which.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "sim/diagnosis/bootstrap.hpp"
#include "sim/diagnosis/parallel.hpp"

namespace sim::diagnosis {
namespace {

using effects::Placed;

std::vector<Placed> candidates(const erp::Robot& robot, const std::vector<std::string>& withhold) {
  std::vector<Placed> all;
  for (const effects::AnyEffect& effect : effects::library()) {
    const effects::About& about = effects::about(effect);
    if (std::ranges::count(withhold, about.type)) continue;
    for (const std::string& on : effects::places(robot, about.seat)) all.push_back({on, effect});
  }
  return all;
}

constexpr double least_gap = 0.02;  // of noise: below, a share of the gap means nothing; chosen

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (!std::isnan(a[k]) && !std::isnan(b[k])) sum += a[k] * b[k];
  return sum;
}

/// How much of Σ z² on one recording the candidate promises to explain: along the change that a
/// nudge of each parameter makes, as if the law were linear. 0: it changes nothing.
double promise(const Trials& trials, const Trial& base, Placed candidate, std::size_t episode) {
  const auto before = trials.whitened(base, episode);
  const std::size_t only[] = {episode};
  double best = 0;
  const Placed neutral = candidate;
  const std::size_t count = effects::parameters(candidate.effect).size();
  for (std::size_t k = 0; k < count; ++k)
    for (const double share : {3e-3, 0.1}) {
      candidate = neutral;
      auto parameters = effects::parameters(candidate.effect);
      if (!parameters[k].fitted) continue;
      const auto& [low, high] = parameters[k].bounds;
      for (std::size_t other = 0; other < k; ++other)  // a shape shows once there is something
        *parameters[other].value += 3e-3 * parameters[other].bounds.high;
      *parameters[k].value += share * (high > 0 ? high : low);
      auto change = trials.whitened(trials.with(base, candidate, only), episode);
      for (std::size_t n = 0; n < change.size(); ++n) change[n] -= before[n];
      const double square = dot(change, change);
      if (square > 1e-12) best = std::max(best, std::pow(dot(before, change), 2) / square);
    }
  for (const Placed& one : tries(trials, neutral, only)) {
    const auto after = trials.whitened(trials.with(base, one, only), episode);
    best = std::max(best, dot(before, before) - dot(after, after));
  }
  return best;
}

/// The recording of the training set with the largest residuals.
std::size_t loudest(const Trials& trials, const Trial& base, const WhichOptions& options) {
  return *std::ranges::max_element(options.train, {}, [&](std::size_t e) {
    const auto z = trials.whitened(base, e);
    return dot(z, z);
  });
}

std::vector<Placed> promising(const Trials& trials, const Trial& base,
                              const WhichOptions& options) {
  const auto all = candidates(trials.nominal(), options.withhold);
  std::vector<double> promised(all.size());
  const std::size_t episode = loudest(trials, base, options);
  in_parallel(all.size(), options.threads,
              [&](std::size_t k) { promised[k] = promise(trials, base, all[k], episode); });
  auto sorted = promised;
  std::ranges::sort(sorted, std::greater());
  const double enough = std::min(options.look_share * sorted[0],
                                 sorted[std::min(options.fitted_at_least, sorted.size()) - 1]);
  std::vector<Placed> chosen;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (promised[k] > 0 && promised[k] >= enough) chosen.push_back(all[k]);
  return chosen;
}

void judge(Ranked& r, const Trials& trials, const Trial& base, const WhichOptions& options) {
  const auto before = trials.blocks(base, options.held_out);
  r.on_held_out = trials.with(base, r.fit.placed, options.held_out);
  r.blocks = trials.blocks(r.on_held_out, options.held_out);
  const auto gain = [&](auto&& each) {
    double was = 0, is = 0, windows = 0;
    each([&](std::size_t k) {
      was += before[k].square, is += r.blocks[k].square;
      windows += static_cast<double>(before[k].windows);
    });
    return (was - is) / std::max(was - windows, least_gap * windows);
  };
  r.gain = gain([&](auto&& add) {
    for (std::size_t k = 0; k < before.size(); ++k) add(k);
  });
  const auto drawn = bootstrap(before.size(), options.draws, options.seed, [&](const auto& blocks) {
    return gain([&](auto&& add) { std::ranges::for_each(blocks, add); });
  });
  r.gain_interval = middle(drawn);
  r.doubt = static_cast<double>(std::ranges::lower_bound(drawn, 0.0) - drawn.begin() + 1) /
            static_cast<double>(drawn.size() + 1);
}

/// A number of the model is off, nothing is new.
bool corrects(const Placed& placed) {
  effects::AnyEffect effect = placed.effect;
  return std::string_view(effects::parameters(effect)[0].name) == "relative";
}

/// Of those as good as the first, the ones with fewer parameters come first, then those that
/// correct a number of the model, then in the order of the chain.
void prefer_plain(std::vector<Ranked>& ranked) {
  constexpr double as_good = 1e-3;  // of the gap; chosen
  if (ranked.empty()) return;
  const double best = ranked[0].gain;
  const auto end =
      std::ranges::find_if(ranked, [&](const Ranked& r) { return r.gain < best - as_good; });
  std::stable_sort(ranked.begin(), end, [](const Ranked& a, const Ranked& b) {
    const auto plainness = [](const Ranked& r) {
      return std::tuple(r.fit.values.size(), !corrects(r.fit.placed), r.fit.placed.effect.index());
    };
    return plainness(a) < plainness(b);
  });
}

}  // namespace

std::vector<Ranked> rank(const Trials& trials, const Trial& base, const WhichOptions& options) {
  const auto chosen = promising(trials, base, options);
  std::vector<Ranked> ranked(chosen.size());
  std::size_t done = 0;
  std::mutex telling;
  in_parallel(chosen.size(), options.threads, [&](std::size_t k) {
    ranked[k].fit = fit(trials, base, chosen[k], options.train);
    judge(ranked[k], trials, base, options);
    const std::lock_guard lock(telling);
    if (options.progress) options.progress(++done, chosen.size());
  });
  std::ranges::stable_sort(ranked, std::greater(), &Ranked::gain);
  prefer_plain(ranked);
  return ranked;
}

std::vector<std::size_t> confusable(const std::vector<Ranked>& ranked,
                                    const std::vector<ScoreBlock>& before,
                                    const WhichOptions& options, double practical) {
  std::vector<std::size_t> same;
  const auto whole = sum(before);
  const double gap = whole.square - static_cast<double>(whole.windows);
  for (std::size_t n = 1; n < ranked.size(); ++n) {
    const auto worse =
        bootstrap(before.size(), options.draws, options.seed, [&](const auto& drawn) {
          double sum = 0;
          for (const std::size_t k : drawn)
            sum += ranked[n].blocks[k].square - ranked[0].blocks[k].square;
          return sum / gap;
        });
    if (middle(worse).low <= 0 || ranked[0].gain - ranked[n].gain < practical) same.push_back(n);
  }
  return same;
}

}  // namespace sim::diagnosis
