#pragma once
#include <string>
#include <vector>

#include "sim/gap/diagnosis/bus.hpp"
#include "sim/gap/diagnosis/identification.hpp"

/// An identified effect: type, place, values, intervals and gain.
namespace sim::diagnosis {

/// An effect of the answer, or a candidate for it.
struct IdentifiedEffect {
  std::string type, on;
  effects::Stage stage;
  std::vector<std::string>
      names;  ///< of the fitted parameters; values, bounds and intervals in this order
  std::vector<double> values;
  std::vector<effects::Bounds> bounds;
  std::vector<Interval> intervals;  ///< 95 %, within the bounds
  double gain = 0;
  Interval gain_interval;
  bool supported = false;
  effects::Placed placed;
  std::vector<double> signature =
      {};  ///< fraction of its change Σ Δz² at each of `Diagnosis::stages`
  std::vector<IdentifiedEffect> alternatives = {};  ///< effects indistinguishable from it
  double similarity = 0;  ///< cosine between its change Δz and the change of the best effect

  /// Whether type and place are those of `other`.
  bool is(const effects::Placed& other) const {
    return placed.on == other.on && placed.effect.index() == other.effect.index();
  }
};

/// Returns the effect with its values. Gain and intervals are 0.
IdentifiedEffect identified(const effects::Placed& placed);
/// Sets `supported` if the interval of the gain is above `least_gain` and the effect relieves a
/// stage. The half width of an interval is 1.96 standard errors of the fit, plus 2 % of the value
/// for the approximation by windows.
IdentifiedEffect identified(const Ranked& ranked, double least_gain);
IdentifiedEffect identified(const BusFit& fit);

/// Returns the reason why the values of an effect are not determined; empty if they are determined.
/// They are not determined if the intervals include the neutral values of all parameters, or if a
/// value is at a bound that is not neutral.
std::string undetermined(const IdentifiedEffect& effect);

/// Whether a fitted value is at a bound that is not its neutral value. There a law degenerates to a
/// simpler one.
bool is_at_bound(const IdentifiedEffect& effect);

/// Clears `supported` where a false discovery rate of 5 % requires it (Benjamini, Hochberg 1995).
void control_discoveries(const std::vector<Ranked>& ranked, std::vector<IdentifiedEffect>& names);

}  // namespace sim::diagnosis
