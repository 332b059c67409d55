#pragma once
#include <vector>

#include "sim/gap/blind/record.hpp"

namespace sim::blind {

/// Whether anyone could see something hidden: a capstan's friction on a straight line, or a worn
/// gear on a muscle that hardly pulls, changes no reading.
class Visibility {
 public:
  explicit Visibility(const erp::Robot& robot);
  /// In one signal at least it changes what is read by as much as noise does, rms, through one of
  /// two excitations. True as well where the robot then falls apart.
  bool operator()(const HiddenEffects& hidden_effects) const;

 private:
  struct Walk {
    Excitation excitation;
    recording::Table plain;
    std::vector<double> noise;  ///< rms, by column; 0: not judged
  };
  const erp::Robot& robot_;
  std::vector<Walk> walks_;
};

}  // namespace sim::blind
