#pragma once
#include <functional>
#include <string>
#include <vector>

#include "sim/control/excitation.hpp"
#include "sim/gap/diagnosis/fit.hpp"

/// The next experiment: the excitation that best separates suspected effects that previous recordings could
/// not distinguish.
///
/// A run with the first suspect is predicted; every other suspect is fitted to it, as the diagnosis would
/// do, and
///
///   split = sqrt(S_other − S_first)       S = Σ z² over stages and windows, each at its best fit
///
/// is their distance in standard deviations of noise (a likelihood ratio). Of the excitations that are safe in
/// every predicted run, the one with the largest minimum split is chosen. A single suspect is separated from
/// the robot without it. Ignores that another suspect may be the true one, and the separation of the others
/// from each other.
namespace sim::closed_loop {

struct ExperimentOptions {
  double seconds = 20;
  int candidates = 24, threads = 2;
  std::uint64_t seed = 1;
  double of_max_tension = 0.85;  ///< limit of tensions, as a share of max_tension_N; chosen
  double to_stop_rad = 0.05;     ///< least distance of hinges from their stops; chosen
  std::function<void(double)> progress = {};  ///< 0 … 1
};

/// Extreme values of predicted runs.
struct Extremes {
  double of_max_tension = 0;  ///< largest tension, as a share of the actuator's limit
  std::string tightest;       ///< its actuator
  double to_stop_rad = 0;     ///< least distance of a hinge from its stop; negative: beyond
  std::string nearest;        ///< its joint
  double saturated = 0;       ///< largest share of the time at the supply voltage
  std::string slowest;        ///< its actuator
};

struct Candidate {
  int kind = 0;  ///< of excitation()
  std::uint64_t seed = 0;
  std::vector<double>
      split;  ///< of each suspect after the first; one alone: from the nominal robot
  double least = 0;
  Extremes extremes;
  std::string unsafe;  ///< the reason; empty: it is safe
};

struct Experiment {
  std::vector<Candidate> candidates;  ///< the best first, unsafe ones last
  Excitation chosen;                  ///< empty if none is safe
};

/// Throws as predict_run, and std::invalid_argument without a suspect.
Experiment next_experiment(const erp::Robot& robot, const std::vector<effects::Placed>& suspects,
                           const ExperimentOptions& options = {});

}  // namespace sim::closed_loop
