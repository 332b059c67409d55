#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/diagnosis/bootstrap.hpp"
#include "sim/diagnosis/trial.hpp"

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
  double excess = 0;
  Interval excess_interval;  ///< 95 %
  double share = 0;
  std::size_t windows = 0;
  bool judged = false;  ///< it has enough windows
  /// It is judged and leaves its floor: the interval's low end is above the practical floor.
  bool open = false;
};

struct WhereOptions {
  double block_s = 1;              ///< of the bootstrap
  int draws = 400;                 ///< of the bootstrap
  double practical_excess = 1;     ///< chosen: 1.4 times the floor may be the method's own
  std::size_t least_windows = 50;  ///< to judge a stage, chosen
  std::uint64_t seed = 1;
};

/// What a trial leaves of the gap at each stage of some recordings, the largest share first.
std::vector<StageGap> where(const Trials& trials, const Trial& trial,
                            std::span<const std::size_t> episodes,
                            const WhereOptions& options = {});
/// Of the nominal robot on all of them. Throws as Trials.
std::vector<StageGap> where(const erp::Robot& robot, std::span<const Episode> episodes,
                            const WhereOptions& options = {});

}  // namespace sim::diagnosis
