#pragma once
#include <functional>
#include <string>
#include <vector>

#include "sim/control/excitation.hpp"
#include "sim/gap/diagnosis/fit.hpp"

/// The next recording: which excitation splits suspects that the last ones could not tell apart.
///
/// The first suspect is rehearsed as if it were the truth; every other is fitted anew to what would
/// have been recorded, as the diagnosis would do, and
///
///   split = sqrt(S_other − S_first)       S = Σ z² over stages and windows, each at its best fit
///
/// is how many standard deviations of noise stand between them (a likelihood ratio). The excitation
/// is chosen that splits best the one that it splits least from the first, among those that are
/// safe in every rehearsal. A single suspect is split from the robot without it. Ignores: that
/// another suspect may be the true one, and how well those after the first are split from each
/// other.
namespace sim::closed_loop {

struct ExperimentOptions {
  double seconds = 20;
  int candidates = 24, threads = 2;
  std::uint64_t seed = 1;
  double of_max_tension = 0.85;  ///< tensions stay below this share of their limits; chosen
  double to_stop_rad = 0.05;     ///< hinges stay farther from their stops; chosen
  std::function<void(double)> progress = {};  ///< 0 … 1
};

/// The most that a rehearsal came to.
struct Extremes {
  double of_max_tension = 0;  ///< share of the actuator's limit, and whose
  std::string tightest;
  double to_stop_rad = 0;  ///< between a hinge and its stop, negative: beyond; and whose
  std::string nearest;
  double saturated = 0;  ///< share of the time at the supply's voltage, and whose
  std::string slowest;
};

struct Candidate {
  int kind = 0;  ///< of excitation()
  std::uint64_t seed = 0;
  std::vector<double>
      split;  ///< of each suspect after the first; one alone: from the nominal robot
  double least = 0;
  Extremes extremes;
  std::string unsafe;  ///< why it is; empty: it is safe
};

struct Experiment {
  std::vector<Candidate> candidates;  ///< the best first, unsafe ones last
  Excitation chosen;                  ///< without rows: none is safe
};

/// Throws as rehearse; std::invalid_argument: no suspect.
Experiment next_experiment(const erp::Robot& robot, const std::vector<effects::Placed>& suspects,
                           const ExperimentOptions& options = {});

}  // namespace sim::closed_loop
