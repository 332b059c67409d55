#include "sim/gap/diagnosis/gap_closure.hpp"

#include <cmath>

#include "sim/gap/residuals/indices.hpp"

namespace sim::diagnosis {
namespace {

double closed_of(const Closed& c) {
  return c.before > c.floor ? (c.before - c.after) / (c.before - c.floor) : 0;
}

/// Σ of the residual above the known noise, in units of the plain noise floor: 1 + (σ_known/σ)² (z_known² − 1).
std::vector<ScoreBlock> above_known_noise(const Evaluator& plain, const Evaluator& known,
                                          const Evaluation& evaluation,
                                          const std::vector<std::size_t>& episodes) {
  std::vector<ScoreBlock> all;
  for (const std::size_t e : episodes) {
    const std::size_t only[] = {e};
    std::vector<ScoreBlock> blocks;
    const auto& residuals = plain.bare().of_episode[e].residuals;
    for (std::size_t r = 0; r < residuals.size(); ++r) {
      const auto this_one = [&](const residuals::Residual& other) {
        return same_stage(other, residuals[r].stage, residuals[r].on);
      };
      const auto same = find_stage(residuals, residuals[r].stage, residuals[r].on);
      if (same - residuals.begin() != std::ptrdiff_t(r)) continue;  // other axes of a ball joint
      const double coarser = known.floor(e, r) / plain.floor(e, r);
      const auto of_stage = known.blocks(evaluation, only, this_one);
      blocks.resize(of_stage.size());
      for (std::size_t k = 0; k < blocks.size() && plain.floor(e, r) > 0; ++k) {
        const auto windows = static_cast<double>(of_stage[k].windows);
        blocks[k].square += windows + coarser * coarser * (of_stage[k].square - windows);
        blocks[k].windows += of_stage[k].windows;
      }
    }
    all.insert(all.end(), blocks.begin(), blocks.end());
  }
  return all;
}

/// Interval of a stage from seconds of the held-out recordings. `coarser`: ratio of the known noise floor to the plain.
Interval closed_interval(const Problem& problem, const std::vector<ScoreBlock>& before,
                         const std::vector<ScoreBlock>& after, double coarser) {
  const auto closed = [&](const std::vector<std::size_t>& drawn) {
    double was = 0, is = 0, windows = 0;
    for (const std::size_t b : drawn)
      was += before[b].square, is += after[b].square, windows += double(before[b].windows);
    const double excess = is / std::max(1.0, windows) - 1;
    return closed_of({"", "", std::sqrt(was / std::max(1.0, windows)), 1,
                      std::sqrt(std::max(0.0, 1 + coarser * coarser * excess))});
  };
  return middle(bootstrap(before.size(), 400, problem.options.seed, closed));
}

}  // namespace

std::vector<Closed> closed_by_stage(const Problem& problem, const Evaluator& plain,
                                    const Evaluator& known, const Evaluation& evaluation) {
  const auto of = [&](const Evaluator& evaluator, const Evaluation& t) {
    return localize(evaluator, t, problem.sets.held_out, problem.localization_options());
  };
  const auto left = of(known, evaluation);
  std::vector<Closed> all;
  for (const StageGap& gap : of(plain, plain.bare())) {
    Closed c{std::string(effects::word(gap.stage)) + " " + gap.on, gap.unit, gap.rms, gap.floor};
    const auto after = find_stage(left, gap.stage, gap.on);
    c.driven_by = gap.driven_by;
    c.after = std::sqrt(
        std::max(0.0, gap.floor * gap.floor + after->excess * after->floor * after->floor));
    c.closed = closed_of(c);
    const auto here = [&](const residuals::Residual& r) {
      return same_stage(r, gap.stage, gap.on);
    };
    c.interval = closed_interval(problem, plain.blocks(plain.bare(), problem.sets.held_out, here),
                                 known.blocks(evaluation, problem.sets.held_out, here),
                                 after->floor / gap.floor);
    all.push_back(c);
  }
  return all;
}

Closed closed_overall(const Problem& problem, const Evaluator& plain, const Evaluator& known,
                      const Evaluation& evaluation) {
  const auto& held_out = problem.sets.held_out;
  const auto before = plain.blocks(plain.bare(), held_out);
  const auto after = above_known_noise(plain, known, evaluation, held_out);
  const auto of = [&](const std::vector<std::size_t>& drawn) {
    Closed c{"all", "noise", 0, 1};
    double was = 0, is = 0, windows = 0;
    for (const std::size_t b : drawn)
      was += before[b].square, is += after[b].square, windows += double(before[b].windows);
    c.before = std::sqrt(was / std::max(windows, 1.0));
    c.after = std::sqrt(std::max(0.0, is / std::max(windows, 1.0)));
    c.closed = closed_of(c);
    return c;
  };
  Closed whole = of(each(before.size()));
  whole.interval = middle(bootstrap(before.size(), 400, problem.options.seed,
                                    [&](const auto& drawn) { return of(drawn).closed; }));
  return whole;
}

}  // namespace sim::diagnosis
