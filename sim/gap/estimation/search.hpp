#pragma once
#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/gap/estimation/screen.hpp"

/// Searches the effects of a robot in addition to its constants. While a stage is open, candidates
/// are screened, the best ones are estimated jointly with the constants, and the one with the
/// lowest cost is added; at most one at each place.
///
///   cost = misfit (remaining_residual.hpp, training and held-out recordings) + prior of the constants
///          + price of each effect
///
/// After each addition the effects that were added before are searched again.
namespace sim::estimation {

struct SearchOptions {
  std::vector<std::string> withhold;  ///< types of effects that are not used
  std::size_t most_effects = 3;
  std::size_t estimated = 8;  ///< number of screened candidates that are estimated
  std::function<void(const std::string&, double)> progress = {};  ///< name of the phase, fraction
};

/// An effect, with the standard deviations of its estimated parameters.
struct SizedEffect {
  effects::Placed effect;
  std::vector<double> sigma;
};
/// The effects of an estimate.
std::vector<SizedEffect> sized_effects(const Estimate& estimate);

/// Effects that cost nearly as little as an effect of an answer.
struct Rivals {
  std::vector<SizedEffect> all;
  std::vector<double>
      cost;         ///< of the answer with each of them as a replacement, the cheapest first
  double gain = 0;  ///< cost without the effect − cost with the effect
};

/// An estimate with effects, its remaining residual and its cost.
struct JudgedEstimate {
  Estimate train;
  RemainingResidual on_train, held_out;
  double cost = 0;
  std::vector<Rivals> rivals = {};  ///< one per effect
  std::vector<double> tolerated;    ///< excess above which each stage is open
};

class Search {
 public:
  Search(const Estimator& train, const ResidualVector& held_out, const Uncertain& uncertain,
         const SearchOptions& options);

  const Uncertain& uncertain() const { return uncertain_; }
  /// Evaluates an estimate on training and held-out recordings.
  JudgedEstimate judge(Estimate estimate) const;
  /// Estimates with the given effects, from their values.
  JudgedEstimate with(const std::vector<effects::Placed>& effects) const {
    return from({{}, effects});
  }
  /// Estimates from the given start.
  JudgedEstimate from(Point start) const;
  /// Adds effects, up to `max_effects` in total, while a stage is open and an effect lowers the
  /// cost.
  JudgedEstimate run(JudgedEstimate found, std::size_t max_effects) const;
  /// Estimates `base` with each of the candidates by a few steps. Returns the cheapest first.
  std::vector<JudgedEstimate> with_each_candidate(const JudgedEstimate& base) const;
  /// Estimates the cheapest of `joined` until convergence. Empty if none costs less than `base`.
  std::optional<JudgedEstimate> best_of(const std::vector<JudgedEstimate>& joined,
                                        const JudgedEstimate& base) const;
  std::optional<JudgedEstimate> with_best_candidate(const JudgedEstimate& base) const {
    return best_of(with_each_candidate(base), base);
  }
  /// Removes effects without which the cost is lower.
  JudgedEstimate pruned(JudgedEstimate found) const;
  /// Removes effects that are at a bound or may be neutral, if the others leave no stage open.
  JudgedEstimate without_doubtful(JudgedEstimate found) const;

 private:
  JudgedEstimate with_best_of(const std::vector<JudgedEstimate>& joined,
                              const JudgedEstimate& base) const;
  JudgedEstimate exchanged(JudgedEstimate found) const;
  JudgedEstimate without(const JudgedEstimate& found, std::size_t effect) const;

  const Estimator& train_;
  const ResidualVector& held_out_;
  const Uncertain& uncertain_;
  SearchOptions options_;
  Screen screen_;
  std::vector<double> tolerated_;
};

/// Whether two answers cost nearly the same. `gain`: decrease of the cost by the better one.
bool are_indistinguishable(double cost, double other, double gain);
/// The effects that could replace one of the effects of `found` at little more cost, the cheapest
/// first.
std::vector<SizedEffect> indistinguishable(const JudgedEstimate& found, std::size_t effect);

/// For each stage, whether its excess in training or held-out recordings is above `tolerated`.
std::vector<bool> open_stages(const JudgedEstimate& found);
inline std::size_t count_open_stages(const JudgedEstimate& found) {
  return std::size_t(std::ranges::count(open_stages(found), true));
}
/// Whether `after` removes a substantial part of the excess of an open stage of `before`.
bool relieves(const JudgedEstimate& after, const JudgedEstimate& before);
inline bool has_open_stage(const JudgedEstimate& found) { return count_open_stages(found) > 0; }

}  // namespace sim::estimation
