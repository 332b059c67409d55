#include "sim/gap/diagnosis/identification.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "interfaces/parallel/in_parallel.hpp"
#include "sim/gap/diagnosis/bootstrap.hpp"
#include "sim/gap/diagnosis/screening.hpp"
#include "sim/gap/residuals/indices.hpp"

namespace sim::diagnosis {
namespace {

using effects::Placed;

// Of the noise; a fraction of a smaller gap is meaningless; chosen.
constexpr double least_gap = 0.02;

/// Scores of a candidate at the open stages and at the stages that it makes worse. Other stages are
/// ignored because a fit of the noise of a stage without a gap is not a gain.
struct Score {
  std::vector<ScoreBlock> before, after;  ///< at these stages
  std::vector<ScoreBlock> gap;            ///< before, at the open stages
};

Score score(const Evaluator& evaluator, const Evaluation& base, const Evaluation& with,
            const RankingOptions& options) {
  const bool has_open_stage = std::ranges::any_of(options.stages, &StageGap::open);
  const auto before = by_stage(evaluator, base, options.held_out);
  const auto after = by_stage(evaluator, with, options.held_out);
  const auto open = [&](const residuals::Residual& r) {
    const auto stage = find_stage(options.stages, r.stage, r.on);
    return !has_open_stage || (stage != options.stages.end() && stage->open);
  };
  const auto counts = [&](const residuals::Residual& r) {
    return open(r) || find_stage(after, r.stage, r.on)->total.square >
                          find_stage(before, r.stage, r.on)->total.square;
  };
  return {evaluator.blocks(base, options.held_out, counts),
          evaluator.blocks(with, options.held_out, counts),
          evaluator.blocks(base, options.held_out, open)};
}

void evaluate(Ranked& r, const Evaluator& evaluator, const Evaluation& base,
              const RankingOptions& options) {
  r.on_held_out = evaluator.with(base, r.fit.placed, options.held_out);
  r.blocks = evaluator.blocks(r.on_held_out, options.held_out);
  const Score s = score(evaluator, base, r.on_held_out, options);
  const auto gain = [&](std::span<const std::size_t> blocks) {
    double before = 0, after = 0, gap = 0, windows = 0;
    for (const std::size_t k : blocks) {
      before += s.before[k].square, after += s.after[k].square, gap += s.gap[k].square;
      windows += static_cast<double>(s.gap[k].windows);
    }
    return (before - after) / std::max(gap - windows, least_gap * windows);
  };
  const auto all_blocks = each(s.before.size());
  r.gain = gain(all_blocks);
  const auto drawn = bootstrap(all_blocks.size(), options.draws, options.seed,
                               [&](const auto& blocks) { return gain(blocks); });
  r.gain_interval = middle(drawn);
  if (std::ranges::any_of(options.stages, &StageGap::open))
    r.relief = relief(evaluator, base, r.on_held_out, options.held_out, options.stages);
  r.p_value = static_cast<double>(std::ranges::lower_bound(drawn, 0.0) - drawn.begin() + 1) /
              static_cast<double>(drawn.size() + 1);
}

/// Whether the effect corrects a constant of the model.
bool is_correction(const Placed& placed) {
  effects::AnyEffect effect = placed.effect;
  return std::string_view(effects::parameters(effect)[0].name) == "relative";
}

/// Interval of Σ z² of `other` minus Σ z² of `best`, over the same blocks.
Interval paired_difference(const Ranked& other, const Ranked& best, const RankingOptions& options) {
  return middle(bootstrap(best.blocks.size(), options.draws, options.seed, [&](const auto& drawn) {
    double difference = 0;
    for (const std::size_t k : drawn) difference += other.blocks[k].square - best.blocks[k].square;
    return difference;
  }));
}

bool is_within_bounds(const Ranked& r) { return !has_size_at_bound(r.fit.placed); }

/// Orders the effects that are equally good as the first: fewer parameters first, then corrections
/// of a constant, then the order of the library.
void prefer_simple(std::vector<Ranked>& ranked, const RankingOptions& options) {
  constexpr double similar_gain = 1e-3, equal_gain = 1e-4;  // differences of gains; chosen
  if (ranked.empty()) return;
  const Ranked best = ranked[0];
  const auto end = std::stable_partition(ranked.begin(), ranked.end(), [&](const Ranked& r) {
    return r.relieves() && is_within_bounds(r) && r.gain >= best.gain - similar_gain &&
           (r.gain >= best.gain - equal_gain || paired_difference(r, best, options).low <= 0);
  });
  std::stable_sort(ranked.begin(), end, [](const Ranked& a, const Ranked& b) {
    const auto complexity = [](const Ranked& r) {
      return std::tuple(r.fit.values.size(), !is_correction(r.fit.placed),
                        r.fit.placed.effect.index());
    };
    return complexity(a) < complexity(b);
  });
}

}  // namespace

std::vector<Ranked> rank(const Evaluator& evaluator, const Evaluation& base,
                         const RankingOptions& options) {
  const auto chosen = screen_effects(evaluator, base, options);
  std::vector<Ranked> ranked(chosen.size());
  std::size_t done = 0;
  std::mutex reporting;
  in_parallel(chosen.size(), options.threads, [&](std::size_t k) {
    ranked[k].fit = fit(evaluator, base, chosen[k], options.train);
    evaluate(ranked[k], evaluator, base, options);
    const std::lock_guard lock(reporting);
    if (options.progress) options.progress(++done, chosen.size());
  });
  std::ranges::stable_sort(ranked, std::greater(), &Ranked::gain);
  // A size at its bound is not an estimate: it reduces residuals by scaling the whole equation
  // down.
  std::ranges::stable_partition(ranked, is_within_bounds);
  std::ranges::stable_partition(ranked, &Ranked::relieves);
  prefer_simple(ranked, options);
  return ranked;
}

std::vector<std::size_t> confusable(const std::vector<Ranked>& ranked,
                                    const RankingOptions& options, double practical) {
  std::vector<std::size_t> same;
  for (std::size_t n = 1; n < ranked.size(); ++n) {
    if (!ranked[n].relieves()) continue;
    if (std::min(1.0, ranked[0].gain) - std::min(1.0, ranked[n].gain) < practical ||
        paired_difference(ranked[n], ranked[0], options).low <= 0)
      same.push_back(n);
  }
  return same;
}

}  // namespace sim::diagnosis
