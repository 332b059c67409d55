#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/bootstrap.hpp"
#include "sim/gap/diagnosis/evaluation.hpp"

/// Localization: the stages whose residual exceeds the noise of their sensors.
///
///   excess = ⟨(r/σ)²⟩ − 1          r: residual, σ: its noise floor; 0: only noise
///   share  = excess / Σ excess      over the open stages; 0 for the others
///
/// Intervals come from a block bootstrap over seconds of the recordings.
namespace sim::diagnosis {

struct StageGap {
  effects::Stage stage;
  std::string on;
  const char* unit;
  double rms = 0, floor = 0;  ///< in that unit
  double driven_by = 0;       ///< rms of the input of the stage, in that unit
  double excess = 0;
  Interval excess_interval;  ///< 95 %
  double worst_excess = 0;   ///< largest excess of a block
  std::size_t windows = 0;
  bool judged = false;  ///< it has enough windows for an evaluation
  double share = 0;
  /// Judged and above its noise floor: the lower end of the interval exceeds practical_excess, or a
  /// block exceeds block_excess.
  bool open = false;
};

struct LocalizationOptions {
  double block_s = 1;              ///< of the bootstrap
  int draws = 400;                 ///< of the bootstrap
  double practical_excess = 0.4;   ///< chosen: the method itself may add 20 % to the noise floor
  double block_excess = 20;        ///< of one block, for intermittent gaps; chosen
  std::size_t least_windows = 50;  ///< to evaluate a stage; chosen
  std::uint64_t seed = 1;
};

/// Whether stage and place of an item are `stage` and `on`.
template <class Item>
bool same_stage(const Item& item, effects::Stage stage, const std::string& on) {
  return item.stage == stage && item.on == on;
}
template <class Items>
auto find_stage(Items& items, effects::Stage stage, const std::string& on) {
  return std::ranges::find_if(items, [&](const auto& i) { return same_stage(i, stage, on); });
}

/// Σ z² and number of windows of one stage over recordings.
struct StageScore {
  effects::Stage stage;
  std::string on;
  ScoreBlock total;
};
std::vector<StageScore> by_stage(const Evaluator& evaluator, const Evaluation& evaluation,
                                 std::span<const std::size_t> episodes);

/// Returns the largest relative reduction of the excess of an open stage from `before` to `after`.
/// 1: a stage is reduced to its noise floor.
double relief(const Evaluator& evaluator, const Evaluation& before, const Evaluation& after,
              std::span<const std::size_t> episodes, std::span<const StageGap> stages);

/// Returns the gap of each stage with the effects of `evaluation`, the largest share first.
std::vector<StageGap> localize(const Evaluator& evaluator, const Evaluation& evaluation,
                               std::span<const std::size_t> episodes,
                               const LocalizationOptions& options = {});
/// For the nominal robot on all recordings. Throws the exceptions of Evaluator.
std::vector<StageGap> localize(const erp::Robot& robot,
                               std::span<const residuals::Episode> episodes,
                               const LocalizationOptions& options = {});

/// Names of the stages that cannot be evaluated in the recordings, such as "gearbox of flexor".
std::vector<std::string> not_evaluated(const erp::Robot& robot,
                                       const std::vector<StageGap>& stages);

}  // namespace sim::diagnosis
