#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "interfaces/parallel/pool.hpp"
#include "sim/gap/diagnosis/fit.hpp"
#include "sim/gap/diagnosis/localization.hpp"

/// Identification: every effect of the library at every place is fitted to the training recordings, one
/// by one, and evaluated on held-out recordings.
///
///   gain = (S₀ − S₁)/(S₀ − N)     S₀, S₁: Σ z² before and after; N: number of windows, Σ z² of noise
///
/// Intervals come from a bootstrap over blocks of the held-out recordings.
namespace sim::diagnosis {

struct RankingOptions {
  std::vector<std::size_t> train, held_out;  ///< recordings
  std::vector<std::string> withhold;         ///< types of effects that are left out
  int threads = 2;
  const Pool* pool = nullptr;  ///< processes for the screening; null: `threads`
  int draws = 400;             ///< of the bootstrap
  std::uint64_t seed = 1;
  std::size_t fitted_at_least = 16;   ///< least number of candidates that pass the screening
  double screen_share = 0.3;          ///< of the best screening score; candidates above it pass too
  std::vector<StageGap> stages = {};  ///< an effect should relieve an open one of these
  /// Called with the number of fitted effects and of all.
  std::function<void(std::size_t, std::size_t)> progress = {};
};

/// A fitted effect, in addition to the effects of the base evaluation.
struct Ranked {
  Fit fit;
  Evaluation on_held_out;
  std::vector<ScoreBlock> blocks;  ///< of the held-out recordings
  double gain = 0;
  Interval gain_interval;  ///< 95 %
  double p_value = 1;      ///< share of draws without a gain
  double relief = 1;       ///< localization.hpp; 1 if `stages` has no open stage
  /// Whether it removes a substantial part of the excess of an open stage. Changes at stages without a
  /// gap explain nothing.
  bool relieves() const { return relief > 0.3; }  // chosen
};

/// Every screened effect, best first. Order: effects that relieve a stage, then sizes within their bounds,
/// then gain; among equally good ones the simpler effect.
std::vector<Ranked> rank(const Evaluator& evaluator, const Evaluation& base,
                         const RankingOptions& options);

/// Indices of the effects that are not distinguishable from the first: the interval of their paired
/// difference to it includes zero, or the difference of the gains (limited to 1) is below `practical`. The
/// first is not included.
std::vector<std::size_t> confusable(const std::vector<Ranked>& ranked,
                                    const RankingOptions& options, double practical = 0.01);

}  // namespace sim::diagnosis
