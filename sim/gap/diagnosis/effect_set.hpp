#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "sim/gap/diagnosis/fit.hpp"
#include "sim/gap/diagnosis/problem.hpp"

/// Several effects fitted together to the training recordings and evaluated on the held-out ones.
namespace sim::diagnosis {

class EffectSet {
 public:
  /// With their present values; nothing is fitted yet.
  EffectSet(const Problem& problem, const Evaluator& evaluator, std::vector<effects::Placed> all);

  std::size_t size() const { return chosen_.size(); }
  const std::vector<effects::Placed>& chosen() const { return chosen_; }
  const std::vector<Fit>& fits() const { return fits_; }
  const Evaluation& evaluation() const { return evaluation_; }
  /// Remaining residual by stage on the held-out recordings; open: unexplained.
  std::vector<StageGap> left(const Tolerance& tolerance) const;
  bool leaves_unexplained(const Tolerance& tolerance) const;
  double square() const;  ///< remaining Σ z² on the held-out recordings

  void refit();
  /// Fits each of the best screened effects together with the present ones and adds the one with the
  /// smallest Σ z², if it helps. Then reconsiders each of the others.
  bool add_another();
  /// Removes effects without which no stage is unexplained.
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

/// The same type of effect on every actuator with an open stage, as after one error in a drawing or a
/// batch: of the types that relieve one of these actuators, the one with the smallest Σ z². A stepwise
/// search does not find it if one other effect, for example of a joint sensor, removes a part of the gap
/// at all actuators at once. Empty if no type closes the gap.
std::optional<EffectSet> same_type_on_open_actuators(const Problem& problem,
                                                     const Evaluator& evaluator,
                                                     const std::vector<Ranked>& ranked);

}  // namespace sim::diagnosis
