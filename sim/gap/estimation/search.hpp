#pragma once
#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/gap/estimation/screen.hpp"

/// Which effects of the library a robot has beside its constants: candidates are screened, the best are
/// estimated together with the constants, and the one joins that costs least,
///
///   cost = misfit (left.hpp, recordings trained on and held out) + prior of the constants
///          + price of each effect
///
/// while a stage keeps more than noise; one at each place. An earlier choice is looked for again beside
/// later ones.
namespace sim::estimation {

struct SearchOptions {
  std::vector<std::string> withhold;  ///< types of effects
  std::size_t most_effects = 3;
  std::size_t estimated = 8;  ///< candidates that pass the screen
  std::function<void(const std::string&, double)> progress = {};
};

/// An effect, with the standard deviations of its estimated parameters.
struct Sized {
  effects::Placed effect;
  std::vector<double> sigma;
};
/// Of an estimate, each of its effects.
std::vector<Sized> sized(const Estimate& estimate);

/// What came near an effect of an answer.
struct Rivals {
  std::vector<Sized> all;
  std::vector<double> cost;  ///< of the answer with each instead, the cheapest first
  double gain = 0;           ///< cost without the effect less that with it
};

/// An estimate with effects, what it leaves, and what it costs.
struct Found {
  Estimate train;
  RemainingResidual on_train, held_out;
  double cost = 0;
  std::vector<Rivals> rivals = {};  ///< one an effect
  std::vector<double> tolerated;    ///< excess of each stage that is not worth an effect
};

class Search {
 public:
  Search(const Estimator& train, const ResidualVector& held_out, const Uncertain& uncertain,
         const SearchOptions& options);

  const Uncertain& uncertain() const { return uncertain_; }
  Found judge(Estimate estimate) const;
  /// With some effects as given.
  Found with(const std::vector<effects::Placed>& effects) const { return from({{}, effects}); }
  /// Estimated from there.
  Found from(Point start) const;
  /// Adds effects, to `most` in all, while a stage keeps more than noise and one helps.
  Found run(Found found, std::size_t most) const;
  /// `base` with each of the candidates, by few steps, the cheapest first.
  std::vector<Found> each_beside(const Found& base) const;
  /// The cheapest of those, estimated to its end; none: none costs less than `base`.
  std::optional<Found> best_of(const std::vector<Found>& joined, const Found& base) const;
  std::optional<Found> best_beside(const Found& base) const {
    return best_of(each_beside(base), base);
  }
  /// Without effects that cost more than they explain beside the others.
  Found pruned(Found found) const;
  /// Without effects that end at a bound or may be neutral, where those that stay leave no more than noise.
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

/// Whether two answers cost nearly the same, of which the better one gains so much.
bool are_indistinguishable(double cost, double other, double gain);
/// What could stand for one of its effects as well: what costs little more, the cheapest first.
std::vector<Sized> indistinguishable(const Found& found, std::size_t effect);

/// Of each stage whether it keeps more than is tolerated, of recordings trained on or held out.
std::vector<bool> open_stages(const Found& found);
inline std::size_t stages_kept(const Found& found) {
  return std::size_t(std::ranges::count(open_stages(found), true));
}
/// Whether an answer takes a good part of what a stage kept.
bool relieves(const Found& is, const Found& was);
inline bool keeps(const Found& found) { return stages_kept(found) > 0; }

}  // namespace sim::estimation
