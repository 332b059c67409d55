#pragma once
#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/gap/estimation/screen.hpp"

/// Which effects of the library a robot has in addition to its constants. While a stage keeps more than noise,
/// candidates are screened, the best are estimated jointly with the constants, and the one of least cost is added; at
/// most one at each place.
///
///   cost = misfit (remaining_residual.hpp, training and held-out recordings) + prior of the constants
///          + price of each effect
///
/// After a later choice, an earlier one is searched for again.
namespace sim::estimation {

struct SearchOptions {
  std::vector<std::string> withhold;  ///< types of effects that are not used
  std::size_t most_effects = 3;
  std::size_t estimated = 8;  ///< candidates that pass the screen
  std::function<void(const std::string&, double)> progress = {};
};

/// An effect, with the standard deviations of its estimated parameters.
struct Sized {
  effects::Placed effect;
  std::vector<double> sigma;
};
/// The effects of an estimate.
std::vector<Sized> sized(const Estimate& estimate);

/// Effects that cost nearly as little as an effect of an answer.
struct Rivals {
  std::vector<Sized> all;
  std::vector<double> cost;  ///< of the answer with each of them instead, the cheapest first
  double gain = 0;           ///< cost without the effect − cost with it
};

/// An estimate with effects, its remaining residual and its cost.
struct Found {
  Estimate train;
  RemainingResidual on_train, held_out;
  double cost = 0;
  std::vector<Rivals> rivals = {};  ///< one per effect
  std::vector<double> tolerated;    ///< excess of each stage that needs no effect
};

class Search {
 public:
  Search(const Estimator& train, const ResidualVector& held_out, const Uncertain& uncertain,
         const SearchOptions& options);

  const Uncertain& uncertain() const { return uncertain_; }
  Found judge(Estimate estimate) const;
  /// Estimate with the given effects.
  Found with(const std::vector<effects::Placed>& effects) const { return from({{}, effects}); }
  /// Estimate from the given start.
  Found from(Point start) const;
  /// Adds effects, up to `most` in total, while a stage keeps more than noise and one lowers the cost.
  Found run(Found found, std::size_t most) const;
  /// `base` with each of the candidates, estimated by few steps, the cheapest first.
  std::vector<Found> with_each_candidate(const Found& base) const;
  /// The cheapest of those, estimated until convergence; empty if none costs less than `base`.
  std::optional<Found> best_of(const std::vector<Found>& joined, const Found& base) const;
  std::optional<Found> with_best_candidate(const Found& base) const {
    return best_of(with_each_candidate(base), base);
  }
  /// Removes effects that cost more than they explain in addition to the others.
  Found pruned(Found found) const;
  /// Removes effects that are at a bound or may be neutral, if the others leave no more than noise.
  Found without_doubtful(Found found) const;

 private:
  Found with_best_of(const std::vector<Found>& joined, const Found& base) const;
  Found exchanged(Found found) const;
  Found without(const Found& found, std::size_t effect) const;

  const Estimator& train_;
  const ResidualVector& held_out_;
  const Uncertain& uncertain_;
  SearchOptions options_;
  Screen screen_;
  std::vector<double> tolerated_;
};

/// Whether two answers cost nearly the same; `gain`: that of the better one.
bool are_indistinguishable(double cost, double other, double gain);
/// Effects that could replace one of its effects at little more cost, the cheapest first.
std::vector<Sized> indistinguishable(const Found& found, std::size_t effect);

/// For each stage, whether it keeps more than is tolerated, in training or held-out recordings.
std::vector<bool> open_stages(const Found& found);
inline std::size_t stages_kept(const Found& found) {
  return std::size_t(std::ranges::count(open_stages(found), true));
}
/// Whether an answer removes a substantial part of a stage's excess.
bool relieves(const Found& after, const Found& before);
inline bool keeps(const Found& found) { return stages_kept(found) > 0; }

}  // namespace sim::estimation
