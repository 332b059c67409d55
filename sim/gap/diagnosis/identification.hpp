#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "interfaces/parallel/pool.hpp"
#include "sim/gap/diagnosis/fit.hpp"
#include "sim/gap/diagnosis/localization.hpp"

/// Which effects explain a gap: every effect of the library at every place, fitted to the training
/// recordings one by one, judged on whole recordings held out.
///
///   gain = (S₀ − S₁)/(S₀ − N)        S before and after, N windows: what noise alone leaves
///
/// with intervals from a bootstrap over blocks of the held-out recordings.
namespace sim::diagnosis {

struct RankingOptions {
  std::vector<std::size_t> train, held_out;  ///< recordings
  std::vector<std::string> withhold;         ///< types of effects that are not tried
  int threads = 2;
  const Pool* pool = nullptr;  ///< where they are screened; none: on `threads`
  int draws = 400;             ///< of the bootstrap
  std::uint64_t seed = 1;
  std::size_t fitted_at_least = 16;   ///< candidates that the linear look lets through
  double screen_share = 0.3;          ///< and all that promise this share of what the best promises
  std::vector<StageGap> stages = {};  ///< of which an effect ought to relieve an open one
  /// Told how many of how many are done.
  std::function<void(std::size_t, std::size_t)> progress = {};
};

/// An effect as fitted, on top of what was chosen before it.
struct Ranked {
  Fit fit;
  Evaluation on_held_out;
  std::vector<ScoreBlock> blocks;  ///< of the held-out recordings
  double gain = 0;
  Interval gain_interval;  ///< 95 %
  double p_value = 1;      ///< share of draws without a gain
  double relief = 1;       ///< where.hpp; 1 also where no stage is named
  /// It takes away a good part of a stage's gap; a change at stages that have none explains
  /// nothing.
  bool relieves() const { return relief > 0.3; }  // chosen
};

/// Every effect that can change a residual, best first: what relieves before what does not, of these a
/// size within its bounds before one at a bound, by gain, ties to the plainer one.
std::vector<Ranked> rank(const Evaluator& evaluator, const Evaluation& base,
                         const RankingOptions& options);

/// Of `ranked`, which cannot be told from the first: their paired difference to it includes zero,
/// or is below `practical` of the gap, of which none takes more than all: beyond is noise. The first
/// is not among them.
std::vector<std::size_t> confusable(const std::vector<Ranked>& ranked,
                                    const RankingOptions& options, double practical = 0.01);

}  // namespace sim::diagnosis
