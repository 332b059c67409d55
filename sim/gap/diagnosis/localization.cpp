#include "sim/gap/diagnosis/localization.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gap/residuals/indices.hpp"

namespace sim::diagnosis {
namespace {

/// Windows of one stage over all recordings.
struct StageWindows {
  const residuals::Residual* residual;
  double floor_square = 0;  ///< Σ σ² over its windows
  double driver_square = 0, recordings = 0;
  std::vector<ScoreBlock> blocks = {};
};

double excess_of(const ScoreBlock& b) {
  return b.windows ? b.square / static_cast<double>(b.windows) - 1 : 0;
}

Interval interval_of(const std::vector<ScoreBlock>& blocks, const LocalizationOptions& options) {
  return middle(bootstrap(blocks.size(), options.draws, options.seed, [&](const auto& drawn) {
    ScoreBlock total;
    for (const std::size_t k : drawn)
      total.square += blocks[k].square, total.windows += blocks[k].windows;
    return excess_of(total);
  }));
}

/// Adds the windows of one stage in one recording.
void collect(std::span<const double> z, double floor, double block_s, StageWindows& stage) {
  const auto windows_a_block =
      static_cast<std::size_t>(std::max(1.0, std::round(block_s / residuals::Windows{}.stride_s)));
  for (std::size_t k = 0; k < z.size(); ++k) {
    if (k % windows_a_block == 0) stage.blocks.emplace_back();
    if (std::isnan(z[k])) continue;
    stage.blocks.back().square += z[k] * z[k], ++stage.blocks.back().windows;
    stage.floor_square += floor * floor;
  }
}

std::vector<StageWindows> collect(const Evaluator& evaluator, const Evaluation& evaluation,
                                  std::span<const std::size_t> episodes,
                                  const LocalizationOptions& options) {
  std::vector<StageWindows> all;
  for (const std::size_t e : episodes) {
    std::size_t first = 0;
    const auto z = evaluator.whitened(evaluation, e);
    const auto& residuals = evaluator.nominal_evaluation().of_episode[e].residuals;
    for (std::size_t r = 0; r < residuals.size(); first += residuals[r++].value.size()) {
      auto place = std::ranges::find_if(all, [&](const StageWindows& c) {
        return same_stage(*c.residual, residuals[r].stage, residuals[r].on);
      });
      if (place == all.end()) place = all.insert(place, {&residuals[r]});
      place->driver_square += residuals[r].driven_by * residuals[r].driven_by, ++place->recordings;
      collect(std::span(z).subspan(first, residuals[r].value.size()), evaluator.floor(e, r),
              options.block_s, *place);
    }
  }
  return all;
}

StageGap gap_of(const StageWindows& collected, const LocalizationOptions& options) {
  const ScoreBlock total = sum(collected.blocks);
  StageGap gap{collected.residual->stage, collected.residual->on, collected.residual->unit};
  gap.windows = total.windows;
  if (gap.windows > 0)
    gap.floor = std::sqrt(collected.floor_square / static_cast<double>(gap.windows));
  gap.driven_by = std::sqrt(collected.driver_square / collected.recordings);
  gap.excess = excess_of(total);
  gap.rms = gap.floor * std::sqrt(std::max(0.0, gap.excess + 1));
  gap.excess_interval = interval_of(collected.blocks, options);
  gap.judged = gap.windows >= options.least_windows;
  constexpr std::size_t fewest_windows = 10;  // windows of a block; chosen
  for (const ScoreBlock& block : collected.blocks)
    if (block.windows >= fewest_windows)
      gap.worst_excess = std::max(gap.worst_excess, excess_of(block));
  gap.open = gap.judged && (gap.excess_interval.low > options.practical_excess ||
                            gap.worst_excess > options.block_excess);
  return gap;
}

}  // namespace

std::vector<StageScore> by_stage(const Evaluator& evaluator, const Evaluation& evaluation,
                                 std::span<const std::size_t> episodes) {
  std::vector<StageScore> all;
  for (const StageWindows& c : collect(evaluator, evaluation, episodes, {}))
    all.push_back({c.residual->stage, c.residual->on, sum(c.blocks)});
  return all;
}

double relief(const Evaluator& evaluator, const Evaluation& before, const Evaluation& after,
              std::span<const std::size_t> episodes, std::span<const StageGap> stages) {
  const auto scores_before = by_stage(evaluator, before, episodes),
             scores_after = by_stage(evaluator, after, episodes);
  double largest = 0;
  for (std::size_t k = 0; k < scores_before.size(); ++k)
    if (const auto stage = find_stage(stages, scores_before[k].stage, scores_before[k].on);
        stage != stages.end() && stage->open)
      largest = std::max(largest,
                         1 - excess_of(scores_after[k].total) / excess_of(scores_before[k].total));
  return largest;
}

std::vector<StageGap> localize(const Evaluator& evaluator, const Evaluation& evaluation,
                               std::span<const std::size_t> episodes,
                               const LocalizationOptions& options) {
  std::vector<StageGap> gaps;
  for (const StageWindows& collected : collect(evaluator, evaluation, episodes, options))
    gaps.push_back(gap_of(collected, options));
  double total = 0;
  for (const StageGap& gap : gaps)
    if (gap.open) total += gap.excess;
  for (StageGap& gap : gaps)
    if (gap.open) gap.share = gap.excess / total;
  std::ranges::stable_sort(gaps, std::greater(), &StageGap::share);
  return gaps;
}

std::vector<StageGap> localize(const erp::Robot& robot,
                               std::span<const residuals::Episode> episodes,
                               const LocalizationOptions& options) {
  const Evaluator evaluator(robot, {episodes.begin(), episodes.end()}, options.seed);
  return localize(evaluator, evaluator.nominal_evaluation(), each(episodes.size()), options);
}

std::vector<std::string> not_evaluated(const erp::Robot& robot,
                                       const std::vector<StageGap>& stages) {
  using effects::Stage;
  std::vector<std::string> names;
  const auto check = [&](Stage stage, const std::string& on) {
    const auto found = find_stage(stages, stage, on);
    if (found == stages.end() || !found->judged)
      names.push_back(std::string(effects::word(stage)) + " of " + on);
  };
  for (const erp::Actuator& a : robot.actuators) {
    if (a.tendon.path.empty()) continue;  // a drive
    for (const Stage stage : {Stage::motor, Stage::gearbox, Stage::tendon}) check(stage, a.name);
  }
  for (const erp::Joint& joint : robot.joints())
    if (joint.type != erp::JointType::fixed) check(Stage::joint, joint.name);
  return names;
}

}  // namespace sim::diagnosis
