#pragma once
#include <string>
#include <vector>

#include "sim/gap/diagnosis/bus.hpp"
#include "sim/gap/diagnosis/identification.hpp"

/// An effect as an answer has it: named, sized, with what it gains.
namespace sim::diagnosis {

/// An effect of the answer, or a candidate for it.
struct IdentifiedEffect {
  std::string type, on;
  effects::Stage stage;
  std::vector<std::string> names;  ///< of its parameters
  std::vector<double> values;
  std::vector<effects::Bounds> bounds;
  std::vector<Interval> intervals;  ///< 95 %, within the bounds
  double gain = 0;
  Interval gain_interval;
  bool supported = false;
  effects::Placed placed;
  std::vector<double> signature = {};  ///< of what it changes, share at each `Diagnosis::stages`
  std::vector<IdentifiedEffect> alternatives =
      {};               ///< of one of the answer: what could stand for it as well
  double likeness = 0;  ///< cosine of what it changes to what the first of the answer changes

  bool is(const effects::Placed& other) const {
    return placed.on == other.on && placed.effect.index() == other.effect.index();
  }
};

/// Without gain and intervals.
IdentifiedEffect identified(const effects::Placed& placed);
/// Supported: the interval of its gain is above `least_gain`, and it relieves a stage. Intervals of
/// values are those of the fit's noise, and 2 % of the value for what the windows approximate.
IdentifiedEffect identified(const Ranked& ranked, double least_gain);
IdentifiedEffect identified(const BusFit& fit);

/// Why its values are not determined: its intervals hold the neutral values of all its parameters, or one
/// is at a bound that is not neutral; empty: they are.
std::string undetermined(const IdentifiedEffect& effect);

/// Whether a fitted value is at a bound that is not neutral: there a law is the limit of a simpler one.
bool is_at_bound(const IdentifiedEffect& effect);

/// Benjamini and Hochberg 1995, at 5 %: what is left of `supported`.
void control_discoveries(const std::vector<Ranked>& ranked, std::vector<IdentifiedEffect>& names);

}  // namespace sim::diagnosis
