#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "sim/gap/diagnosis/fit.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// Several effects, jointly fitted to the training recordings and evaluated on the held-out
/// recordings.
namespace sim::diagnosis {

class EffectSet {
 public:
  /// Effects with their present values, not yet fitted.
  EffectSet(const Problem& problem, const Evaluator& evaluator, std::vector<effects::Placed> all);

  std::size_t size() const { return chosen_.size(); }
  const std::vector<effects::Placed>& chosen() const { return chosen_; }
  const std::vector<Fit>& fits() const { return fits_; }
  const Evaluation& evaluation() const { return evaluation_; }
  /// Remaining residual of each stage on the held-out recordings. `open`: above the tolerance.
  std::vector<StageGap> remaining(const Tolerance& tolerance) const;
  bool leaves_unexplained(const Tolerance& tolerance) const;
  double square() const;  ///< remaining Σ z² on the held-out recordings

  void refit();
  /// Fits each of the best screened effects jointly with the present ones. Adds the one with the
  /// smallest Σ z² if it removes half of the remaining excess of an open stage. Then reconsiders
  /// each of the others. Returns whether an effect was added.
  bool add_another();
  /// Removes effects without which no stage is unexplained.
  void remove_unnecessary();

 private:
  const Sets& sets() const { return problem_.get().sets; }
  bool has(const effects::Placed& other) const;
  bool helps(const EffectSet& before) const;
  void reconsider(std::size_t k, double progress_begin, double progress_end);

  std::reference_wrapper<const Problem> problem_;
  std::reference_wrapper<const Evaluator> evaluator_;
  std::vector<effects::Placed> chosen_;
  std::vector<Fit> fits_;
  Evaluation evaluation_;
};

/// Returns `all` without element k.
std::vector<effects::Placed> without_element(std::vector<effects::Placed> all, std::size_t k);
bool any_open(const std::vector<StageGap>& gaps);

/// The same type of effect on every actuator with an open stage, as caused by an error in a drawing
/// or a batch: of the types that relieve one of these actuators, the one with the smallest Σ z². A
/// stepwise search does not find it if another effect, for example of a joint sensor, removes a
/// part of the gap of all actuators. Empty if no type closes the gap.
std::optional<EffectSet> same_type_on_open_actuators(const Problem& problem,
                                                     const Evaluator& evaluator,
                                                     const std::vector<Ranked>& ranked);

}  // namespace sim::diagnosis
