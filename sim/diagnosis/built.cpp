#include "sim/diagnosis/built.hpp"

#include <algorithm>
#include <cmath>

#include "sim/diagnosis/selection.hpp"
#include "sim/diagnosis/shape.hpp"

namespace sim::diagnosis {
namespace {

std::vector<residuals::Episode> some(const Evidence& evidence,
                                     const std::vector<std::size_t>& set) {
  std::vector<residuals::Episode> episodes;
  for (const std::size_t k : set) episodes.push_back(evidence.episodes[k]);
  return episodes;
}

std::vector<ConstantEstimate> constants_of(const gap::AsBuilt& built) {
  std::vector<ConstantEstimate> all;
  for (std::size_t k = 0; k < built.uncertain.constants.size(); ++k) {
    const gap::Constant& c = built.uncertain.constants[k];
    const double x = built.estimate.point.x[k], half = 1.96 * built.estimate.sigma(k);
    all.push_back({c.name,
                   c.on,
                   c.stage,
                   c.nominal,
                   c.tolerance,
                   c.value(x),
                   {c.value(x - half), c.value(x + half)},
                   gap::determined(built, k),
                   std::ranges::count(built.beyond, k) > 0});
  }
  return all;
}

Named with_intervals(gap::Sized sized) {
  constexpr double of_method = 0.02;  // of the value: what windows approximate; chosen
  Named n = named(sized.effect);
  std::size_t p = 0, estimated = 0;
  for (const effects::Parameter& parameter : effects::parameters(sized.effect.effect)) {
    if (!gap::is_estimated(parameter)) continue;
    const double sigma = sized.sigma[estimated++];
    if (!parameter.fitted) continue;
    const double half = 1.96 * sigma + of_method * std::abs(n.values[p]);
    n.intervals[p] = {std::max(n.values[p] - half, n.bounds[p].low),
                      std::min(n.values[p] + half, n.bounds[p].high)};
    ++p;
  }
  return n;
}

/// The n-th constant beyond its tolerance, with what could be in its place.
Named beyond(const gap::AsBuilt& built, std::size_t n) {
  const std::size_t k = built.beyond[n];
  Named named = with_intervals(gap::as_effect(
      built.uncertain.constants[k], {k, built.estimate.point.x[k], built.estimate.sigma(k)}));
  for (const gap::Sized& other : built.instead[n])
    if (effects::name_of(other.effect) != effects::name_of(named.placed))
      named.alternatives.push_back(with_intervals(other));
  return named;
}

/// The effects found, with their intervals and what could stand for each.
std::vector<Named> effects_of(const gap::AsBuilt& built) {
  std::vector<Named> all;
  for (const gap::Sized& sized : gap::sized(built.estimate)) {
    Named n = with_intervals(sized);
    for (const gap::Sized& other : built.indistinguishable[all.size()])
      n.alternatives.push_back(with_intervals(other));
    all.push_back(std::move(n));
  }
  return all;
}

bool ends_at_bound(const gap::Estimate& estimate) {
  return std::ranges::count(estimate.bound, true) > 0;
}

Trials trials_of(const Evidence& evidence, const erp::Robot& robot) {
  return {robot, evidence.episodes, evidence.options.seed};
}

/// Σ z² of the recordings held out, by a robot with that point.
double square_at(const Evidence& evidence, const Trials& plain, const erp::Robot& robot) {
  residuals::Stages stages(robot);
  Trial trial{{}, std::vector<residuals::Explanation>(evidence.episodes.size())};
  for (const std::size_t e : evidence.sets.held_out)
    trial.of_episode[e] = stages.explain(evidence.episodes[e]);
  return sum(plain.blocks(trial, evidence.sets.held_out)).square;
}

/// What the recordings held out lose without each part of the answer, as a share of the gap.
void set_gains(const Evidence& evidence, const Trials& plain, const gap::AsBuilt& built,
               std::vector<Named>& answer) {
  const ScoreBlock before = sum(plain.blocks(plain.bare(), evidence.sets.held_out));
  const double gap = std::max(before.square - double(before.windows), 1e-9);
  const double all = square_at(evidence, plain, built.robot);
  const std::size_t effects = built.estimate.point.effects.size();
  for (std::size_t k = 0; k < answer.size(); ++k) {
    gap::Point without = built.estimate.point;
    if (k < effects) without.effects.erase(without.effects.begin() + std::ptrdiff_t(k));
    else without.x[built.beyond[k - effects]] = 0;
    const double left = square_at(evidence, plain, gap::robot_at(built.uncertain, without));
    answer[k].gain = std::clamp((left - all) / gap, 0.0, 1.0);
    answer[k].gain_interval = {answer[k].gain, answer[k].gain};
    answer[k].supported = true;
  }
}

/// Excess of a stage without the hundredth of its seconds that keeps most: one event is no law.
double without_events(const Trials& trials, const StageGap& gap,
                      const std::vector<std::size_t>& set) {
  auto blocks = trials.blocks(trials.bare(), set, [&](const residuals::Residual& r) {
    return same_stage(r, gap.stage, gap.on);
  });
  std::ranges::sort(blocks, {}, &ScoreBlock::square);
  blocks.resize(blocks.size() - std::min(blocks.size(), blocks.size() / 100 + 1));
  const ScoreBlock whole = sum(blocks);
  return whole.windows ? whole.square / double(whole.windows) - 1 : 0;
}

std::vector<StageGap> left_by(const Evidence& evidence, const Trials& plain, const Trials& built) {
  const auto held_out = [&](const Trials& trials) {
    return where(trials, trials.bare(), evidence.sets.held_out, evidence.where_options());
  };
  const auto before = held_out(plain);
  auto left = held_out(built);
  for (StageGap& gap : left) {
    const auto was = find_stage(before, gap.stage, gap.on);
    const double usual = without_events(built, gap, evidence.sets.held_out);
    gap.open = gap.open && usual > evidence.where_options().practical_excess &&
               stays_open(gap.excess, was->excess, evidence.options.together, [&] {
                 return follows(built, built.bare(), gap.stage, gap.on, evidence.sets);
               });
  }
  return left;
}

}  // namespace

bool Built::explained() const { return !at_bound && std::ranges::none_of(left, &StageGap::open); }

Built as_built(const Evidence& evidence, const Trials& plain, const std::vector<Named>& suggested) {
  const auto train = some(evidence, evidence.sets.train),
             held_out = some(evidence, evidence.sets.held_out);
  gap::AsBuiltOptions options;
  options.estimate.threads = evidence.options.threads,
  options.estimate.seed = evidence.options.seed;
  for (const Named& n : suggested) options.suggested.push_back(n.placed);
  options.search.withhold = evidence.options.withhold;
  options.search.most_effects = evidence.options.most_effects;
  options.search.progress = [&](const std::string& what, double share) {
    evidence.tell(what, 0.6 + 0.3 * share);
  };
  const gap::AsBuilt found = gap::as_built(evidence.robot, train, held_out, options);
  std::vector<Named> answer = effects_of(found);
  for (std::size_t n = 0; n < found.beyond.size(); ++n) answer.push_back(beyond(found, n));
  set_gains(evidence, plain, found, answer);
  Built built{found.robot,
              constants_of(found),
              std::move(answer),
              trials_of(evidence, found.robot),
              {},
              found.exact,
              ends_at_bound(found.estimate)};
  built.left = left_by(evidence, plain, built.trials);
  return built;
}

}  // namespace sim::diagnosis
