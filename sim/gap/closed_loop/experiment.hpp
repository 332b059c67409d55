#pragma once
#include <functional>
#include <string>
#include <vector>

#include "sim/control/excitation.hpp"
#include "sim/gap/diagnosis/fit.hpp"

/// The next experiment: the excitation that best separates suspected effects that previous
/// recordings do not distinguish.
///
/// A run with the first suspect is predicted. Every other suspect is fitted to this run by the
/// method of the diagnosis:
///
///   split = sqrt(S_other − S_first)       S = Σ z² over stages and windows, each at its best fit
///
/// The split is the distance of two suspects in standard deviations of noise (a likelihood ratio).
/// Of the excitations that are safe in every predicted run, the one with the largest minimum split
/// is chosen. A single suspect is compared with the robot without it. Ignores that another suspect
/// may be the true one, and the separation of the others from each other.
namespace sim::closed_loop {

struct ExperimentOptions {
  double seconds = 20;
  int candidates = 24, threads = 2;
  std::uint64_t seed = 1;
  double tension_fraction = 0.85;   ///< limit of tensions, relative to max_tension_N; chosen
  double stop_distance_rad = 0.05;  ///< smallest distance of hinges from their stops; chosen
  std::function<void(double)> progress = {};  ///< 0 … 1
};

/// Extreme values of predicted runs.
struct Extremes {
  double tension_fraction = 0;     ///< largest tension, relative to the actuator's limit
  std::string tension_actuator;    ///< the actuator with this tension
  double stop_distance_rad = 0;    ///< smallest distance of a hinge from its stop; negative: beyond
  std::string stop_joint;          ///< the joint with this distance
  double saturated_fraction = 0;   ///< largest fraction of the time at the supply voltage
  std::string saturated_actuator;  ///< the actuator with this fraction
};

struct Candidate {
  int kind = 0;  ///< of excitation()
  std::uint64_t seed = 0;
  std::vector<double>
      split;  ///< of each other suspect; of a single suspect: from the nominal robot
  double least_split = 0;
  Extremes extremes;
  std::string unsafe;  ///< the reason; empty: safe
};

struct Experiment {
  std::vector<Candidate> candidates;  ///< the best first, unsafe candidates last
  Excitation chosen;                  ///< empty if no candidate is safe
};

/// Chooses the next experiment. Throws the exceptions of predict_run, and std::invalid_argument
/// without a suspect.
Experiment next_experiment(const erp::Robot& robot, const std::vector<effects::Placed>& suspects,
                           const ExperimentOptions& options = {});

}  // namespace sim::closed_loop
