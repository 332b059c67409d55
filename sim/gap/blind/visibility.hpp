#pragma once
#include <vector>

#include "sim/gap/blind/record.hpp"

namespace sim::blind {

/// Whether a hidden effect is visible in any reading. Capstan friction on a straight line is
/// invisible, for example, and a worn gear of a muscle with small forces.
class Visibility {
 public:
  explicit Visibility(const erp::Robot& robot);
  /// Returns whether the effects change at least one signal by more than its noise (rms) in one of
  /// two excitations. Returns true if the motion diverges.
  bool operator()(const HiddenEffects& hidden_effects) const;

 private:
  struct Run {
    Excitation excitation;
    recording::Table without_effects;
    std::vector<double> noise;  ///< rms, by column; 0: not evaluated
  };
  const erp::Robot& robot_;
  std::vector<Run> runs_;
};

}  // namespace sim::blind
