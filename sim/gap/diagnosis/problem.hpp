#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/identification.hpp"
#include "sim/gap/diagnosis/split.hpp"

/// Inputs of a diagnosis: robot, recordings, options.
namespace sim::diagnosis {

/// A stage is explained if its remaining excess is below the largest of these limits.
struct Tolerance {
  /// share: relative to its nominal excess; of_largest: relative to the largest excess of a stage.
  double excess, share, of_largest;
};

struct DiagnoseOptions {
  std::vector<std::size_t> train, held_out;  ///< recordings; both empty: split by the diagnosis
  std::vector<std::string> withhold;
  int threads = 2;
  const Pool* pool = nullptr;  ///< the processes of `mpirun`; null: only `threads`
  std::uint64_t seed = 1;
  std::size_t most_effects = 3;
  /// Tolerated excess of a stage: with a single effect, whose law may differ in form; with several
  /// effects; in the search for another effect. Chosen on development cases.
  Tolerance single{5, 0.005, 0.001}, effect_set{2, 0.005, 0}, search{1.5, 0.005, 0};
  double least_gain = 0.02;  ///< lower end of the interval of the gain of a supported effect
  /// Called with the name of the step and the completed fraction, 0 … 1.
  std::function<void(const std::string&, double)> progress = {};
};

struct Problem {
  const erp::Robot& robot;
  std::vector<residuals::Episode> episodes;
  DiagnoseOptions options;
  Sets sets;

  void report_progress(const std::string& step, double fraction) const {
    if (options.progress) options.progress(step, fraction);
  }
  LocalizationOptions localization_options() const { return {.seed = options.seed}; }
  /// The progress of the ranking is reported as `begin` … `end`.
  RankingOptions ranking_options(double begin = 0, double end = 0) const;
};

}  // namespace sim::diagnosis
