#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/bootstrap.hpp"
#include "sim/gap/diagnosis/evaluation.hpp"

/// Where the gap lies: which stages are left with more than the noise of their sensors.
///
///   excess = ⟨(r/σ)²⟩ − 1          r residual, σ its noise floor; 0: nothing but noise
///   share  = excess / Σ excess      of the stages that leave their floor; 0 for the others
///
/// with intervals from a block bootstrap over seconds of the recordings.
namespace sim::diagnosis {

struct StageGap {
  effects::Stage stage;
  std::string on;
  const char* unit;
  double rms = 0, floor = 0;  ///< in that unit
  double driven_by = 0;       ///< rms of what drives the stage, in that unit
  double excess = 0;
  Interval excess_interval;  ///< 95 %
  double worst_excess = 0;   ///< of a block
  std::size_t windows = 0;
  bool judged = false;  ///< it has enough windows
  double share = 0;
  /// It is judged and leaves its floor: the interval's low end is above the practical floor, or a
  /// block is far above it.
  bool open = false;
};

struct LocalizationOptions {
  double block_s = 1;              ///< of the bootstrap
  int draws = 400;                 ///< of the bootstrap
  double practical_excess = 0.4;   ///< chosen: 1.2 times the floor may be the method's own
  double block_excess = 20;        ///< chosen: of one block alone; a gap may come and go
  std::size_t least_windows = 50;  ///< to judge a stage, chosen
  std::uint64_t seed = 1;
};

/// Whether something with `stage` and `on` belongs there.
template <class Item>
bool same_stage(const Item& item, effects::Stage stage, const std::string& on) {
  return item.stage == stage && item.on == on;
}
template <class Items>
auto find_stage(Items& items, effects::Stage stage, const std::string& on) {
  return std::ranges::find_if(items, [&](const auto& i) { return same_stage(i, stage, on); });
}

/// What a trial leaves at one stage of some recordings: Σ z² and how many windows.
struct StageScore {
  effects::Stage stage;
  std::string on;
  ScoreBlock whole;
};
std::vector<StageScore> by_stage(const Evaluator& evaluator, const Evaluation& evaluation,
                                 std::span<const std::size_t> episodes);

/// Of the excess of a stage that is open, the most that `after` takes away of what `before` leaves
/// there: 1: it brings one of them to its floor.
double relief(const Evaluator& evaluator, const Evaluation& before, const Evaluation& after,
              std::span<const std::size_t> episodes, std::span<const StageGap> stages);

/// What a trial leaves of the gap at each stage of some recordings, the largest share first.
std::vector<StageGap> localize(const Evaluator& evaluator, const Evaluation& evaluation,
                               std::span<const std::size_t> episodes,
                               const LocalizationOptions& options = {});
/// Of the nominal robot on all of them. Throws as Trials.
std::vector<StageGap> localize(const erp::Robot& robot,
                               std::span<const residuals::Episode> episodes,
                               const LocalizationOptions& options = {});

/// What such a robot has and the recordings say too little of, in words: "gearbox of flexor".
std::vector<std::string> not_evaluated(const erp::Robot& robot,
                                       const std::vector<StageGap>& stages);

}  // namespace sim::diagnosis
