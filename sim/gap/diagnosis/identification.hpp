#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "interfaces/parallel/pool.hpp"
#include "sim/gap/diagnosis/fit.hpp"
#include "sim/gap/diagnosis/localization.hpp"

/// Identification: every effect of the library at every place is fitted individually to the
/// training recordings and evaluated on held-out recordings.
///
///   gain = (S₀ − S₁)/(S₀ − N)     S₀, S₁: Σ z² before and after; N: number of windows, Σ z² of noise
///
/// Intervals are computed by a bootstrap over blocks of the held-out recordings.
namespace sim::diagnosis {

struct RankingOptions {
  std::vector<std::size_t> train, held_out;  ///< recordings
  std::vector<std::string> withhold;         ///< types of effects that are omitted
  int threads = 2;
  const Pool* pool = nullptr;  ///< processes for the screening; null: only `threads`
  int draws = 400;             ///< of the bootstrap
  std::uint64_t seed = 1;
  std::size_t fitted_at_least = 16;   ///< least number of candidates that pass the screening
  double screen_share = 0.3;          ///< candidates above this fraction of the best score pass too
  std::vector<StageGap> stages = {};  ///< an effect should relieve an open stage of these
  /// Called with the number of fitted effects and the number of all effects.
  std::function<void(std::size_t, std::size_t)> progress = {};
};

/// A fitted effect, in addition to the effects of the base evaluation.
struct Ranked {
  Fit fit;
  Evaluation on_held_out;
  std::vector<ScoreBlock> blocks;  ///< of the held-out recordings
  double gain = 0;
  Interval gain_interval;  ///< 95 %
  double p_value = 1;      ///< fraction of draws without a gain
  double relief = 1;       ///< localization.hpp; 1 if `stages` has no open stage
  /// Whether the effect removes a substantial part of the excess of an open stage. Changes at
  /// stages without a gap explain nothing.
  bool relieves() const { return relief > 0.3; }  // chosen
};

/// Fits every screened effect and returns the best first. Order: effects that relieve a stage, then
/// sizes within their bounds, then gain; of equally good effects the simpler one.
std::vector<Ranked> rank(const Evaluator& evaluator, const Evaluation& base,
                         const RankingOptions& options);

/// Returns the indices of the effects that are not distinguishable from the first: the interval of
/// their paired difference to the first includes zero, or the difference of the gains (limited to
/// 1) is below `practical`. The first is not included.
std::vector<std::size_t> confusable(const std::vector<Ranked>& ranked,
                                    const RankingOptions& options, double practical = 0.01);

}  // namespace sim::diagnosis
