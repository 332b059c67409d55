#include "sim/gap/diagnosis/gap_closure.hpp"

#include <cmath>

#include "sim/gap/residuals/indices.hpp"

namespace sim::diagnosis {
namespace {

constexpr int bootstrap_draws = 400;  // chosen

double closed_of(const ClosedGap& c) {
  return c.before > c.floor ? (c.before - c.after) / (c.before - c.floor) : 0;
}

/// Blocks of the residual above the corrected noise floor σ_c, in units of the baseline noise floor
/// σ, with z_c = r/σ_c:
///
///   z² = 1 + (σ_c/σ)² (z_c² − 1)
std::vector<ScoreBlock> above_corrected_noise(const Evaluator& baseline, const Evaluator& corrected,
                                              const Evaluation& evaluation,
                                              const std::vector<std::size_t>& episodes) {
  std::vector<ScoreBlock> all;
  for (const std::size_t e : episodes) {
    const std::size_t only[] = {e};
    std::vector<ScoreBlock> blocks;
    const auto& residuals = baseline.nominal_evaluation().of_episode[e].residuals;
    for (std::size_t r = 0; r < residuals.size(); ++r) {
      const auto this_one = [&](const residuals::Residual& other) {
        return same_stage(other, residuals[r].stage, residuals[r].on);
      };
      const auto same = find_stage(residuals, residuals[r].stage, residuals[r].on);
      if (same - residuals.begin() != std::ptrdiff_t(r)) continue;  // other axes of a ball joint
      const double floor_ratio = corrected.floor(e, r) / baseline.floor(e, r);
      const auto stage_blocks = corrected.blocks(evaluation, only, this_one);
      blocks.resize(stage_blocks.size());
      for (std::size_t k = 0; k < blocks.size() && baseline.floor(e, r) > 0; ++k) {
        const auto windows = static_cast<double>(stage_blocks[k].windows);
        blocks[k].square +=
            windows + floor_ratio * floor_ratio * (stage_blocks[k].square - windows);
        blocks[k].windows += stage_blocks[k].windows;
      }
    }
    all.insert(all.end(), blocks.begin(), blocks.end());
  }
  return all;
}

/// Interval of a stage from seconds of the held-out recordings. `floor_ratio`: corrected / baseline
/// noise floor.
Interval closed_interval(const Problem& problem, const std::vector<ScoreBlock>& before,
                         const std::vector<ScoreBlock>& after, double floor_ratio) {
  const auto closed = [&](const std::vector<std::size_t>& drawn) {
    double square_before = 0, square_after = 0, windows = 0;
    for (const std::size_t b : drawn)
      square_before += before[b].square, square_after += after[b].square,
          windows += double(before[b].windows);
    const double excess = square_after / std::max(1.0, windows) - 1;
    return closed_of({"", "", std::sqrt(square_before / std::max(1.0, windows)), 1,
                      std::sqrt(std::max(0.0, 1 + floor_ratio * floor_ratio * excess))});
  };
  return middle(bootstrap(before.size(), bootstrap_draws, problem.options.seed, closed));
}

}  // namespace

std::vector<ClosedGap> closed_by_stage(const Problem& problem, const Evaluator& baseline,
                                       const Evaluator& corrected, const Evaluation& evaluation) {
  const auto of = [&](const Evaluator& evaluator, const Evaluation& t) {
    return localize(evaluator, t, problem.sets.held_out, problem.localization_options());
  };
  const auto remaining = of(corrected, evaluation);
  std::vector<ClosedGap> all;
  for (const StageGap& gap : of(baseline, baseline.nominal_evaluation())) {
    ClosedGap c{std::string(effects::word(gap.stage)) + " " + gap.on, gap.unit, gap.rms, gap.floor};
    const auto after = find_stage(remaining, gap.stage, gap.on);
    c.driven_by = gap.driven_by;
    c.after = std::sqrt(
        std::max(0.0, gap.floor * gap.floor + after->excess * after->floor * after->floor));
    c.closed = closed_of(c);
    const auto is_this_stage = [&](const residuals::Residual& r) {
      return same_stage(r, gap.stage, gap.on);
    };
    c.interval = closed_interval(
        problem,
        baseline.blocks(baseline.nominal_evaluation(), problem.sets.held_out, is_this_stage),
        corrected.blocks(evaluation, problem.sets.held_out, is_this_stage),
        after->floor / gap.floor);
    all.push_back(c);
  }
  return all;
}

ClosedGap closed_overall(const Problem& problem, const Evaluator& baseline,
                         const Evaluator& corrected, const Evaluation& evaluation) {
  const auto& held_out = problem.sets.held_out;
  const auto before = baseline.blocks(baseline.nominal_evaluation(), held_out);
  const auto after = above_corrected_noise(baseline, corrected, evaluation, held_out);
  const auto of = [&](const std::vector<std::size_t>& drawn) {
    ClosedGap c{"all", "noise", 0, 1};
    double square_before = 0, square_after = 0, windows = 0;
    for (const std::size_t b : drawn)
      square_before += before[b].square, square_after += after[b].square,
          windows += double(before[b].windows);
    c.before = std::sqrt(square_before / std::max(windows, 1.0));
    c.after = std::sqrt(std::max(0.0, square_after / std::max(windows, 1.0)));
    c.closed = closed_of(c);
    return c;
  };
  ClosedGap total = of(each(before.size()));
  total.interval = middle(bootstrap(before.size(), bootstrap_draws, problem.options.seed,
                                    [&](const auto& drawn) { return of(drawn).closed; }));
  return total;
}

}  // namespace sim::diagnosis
