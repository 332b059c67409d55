#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "sim/gap/diagnosis/fit.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// Effects that are tried together on their way to an answer, fitted to the training recordings and
/// judged on those held out.
namespace sim::diagnosis {

class EffectSet {
 public:
  /// As they are: nothing is fitted yet.
  EffectSet(const Problem& problem, const Evaluator& evaluator, std::vector<effects::Placed> all);

  std::size_t size() const { return chosen_.size(); }
  const std::vector<effects::Placed>& chosen() const { return chosen_; }
  const std::vector<Fit>& fits() const { return fits_; }
  const Evaluation& evaluation() const { return evaluation_; }
  /// The stages that they leave, on the held-out recordings.
  std::vector<StageGap> left(const Tolerance& tolerance) const;
  bool leaves_unexplained(const Tolerance& tolerance) const;
  double square() const;  ///< Σ z² that they leave there

  void refit();
  /// Of the effects that promise most beside the others, the one that leaves least when all are
  /// fitted together, if it helps; then each of the others is reconsidered.
  bool add_another();
  /// One goes that the others have made superfluous: without it no stage opens.
  void drop_superfluous();

 private:
  const Sets& sets() const { return problem_.get().sets; }
  bool has(const effects::Placed& other) const;
  bool helps(const EffectSet& before) const;
  void reconsider(std::size_t k, double from, double to);

  std::reference_wrapper<const Problem> problem_;
  std::reference_wrapper<const Evaluator> evaluator_;
  std::vector<effects::Placed> chosen_;
  std::vector<Fit> fits_;
  Evaluation evaluation_;
};

std::vector<effects::Placed> all_but(std::vector<effects::Placed> all, std::size_t k);
bool any_open(const std::vector<StageGap>& gaps);

/// The same mistake on every actuator, as of one drawing or one batch: of each kind of effect that
/// relieves one of those that differ, one at each of them; the kind that leaves least. Never found by
/// one effect after another where a single other one, say of a joint's sensor, takes part of it
/// away at all of them at once. Nothing: none closes the gap.
std::optional<EffectSet> of_one_batch(const Problem& problem, const Evaluator& evaluator,
                                      const std::vector<Ranked>& ranked);

}  // namespace sim::diagnosis
