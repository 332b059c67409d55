#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/identification.hpp"
#include "sim/gap/diagnosis/split.hpp"

/// Inputs of a diagnosis: robot, recordings, options.
namespace sim::diagnosis {

/// A remaining excess below the largest of these limits counts as explained.
struct Tolerance {
  double excess, share, of_most;  ///< share: of its nominal excess; of_most: of the largest excess
};

struct DiagnoseOptions {
  std::vector<std::size_t> train, held_out;  ///< recordings; both empty: split by the diagnosis
  std::vector<std::string> withhold;
  int threads = 2;
  const Pool* pool = nullptr;  ///< the processes of `mpirun`; null: `threads` alone
  std::uint64_t seed = 1;
  std::size_t most_effects = 3;
  /// Excess that a stage may keep, all chosen on development cases: with one effect, whose law may
  /// differ in form; with several effects; before another effect is searched.
  Tolerance alone{5, 0.005, 0.001}, together{2, 0.005, 0}, search{1.5, 0.005, 0};
  double least_gain = 0.02;  ///< lower end of the interval of the gain of a supported effect
  /// Called with the present step and the completed share, 0 … 1.
  std::function<void(const std::string&, double)> progress = {};
};

struct Problem {
  const erp::Robot& robot;
  std::vector<residuals::Episode> episodes;
  DiagnoseOptions options;
  Sets sets;

  void report_progress(const std::string& what, double share) const {
    if (options.progress) options.progress(what, share);
  }
  LocalizationOptions localization_options() const { return {.seed = options.seed}; }
  /// The progress of the ranking is reported as `from` … `to`.
  RankingOptions ranking_options(double from = 0, double to = 0) const;
};

}  // namespace sim::diagnosis
