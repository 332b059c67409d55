#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/identification.hpp"
#include "sim/gap/diagnosis/split.hpp"

/// What a diagnosis is asked, and what it has to go by.
namespace sim::diagnosis {

/// An excess that is left counts as none below the largest of these.
struct Tolerance {
  double excess, share, of_most;  ///< share: of what it was; of_most: of the largest excess
};

struct DiagnoseOptions {
  std::vector<std::size_t> train, held_out;  ///< recordings; both empty: split by the diagnosis
  std::vector<std::string> withhold;
  int threads = 2;
  const Pool* pool = nullptr;  ///< the processes of `mpirun`; none: `threads` alone
  std::uint64_t seed = 1;
  std::size_t most_effects = 3;
  /// What a stage may keep and count as explained, all chosen on development cases: by one effect,
  /// whose law may be of another shape; by several; before another effect is looked for.
  Tolerance alone{5, 0.005, 0.001}, together{2, 0.005, 0}, search{1.5, 0.005, 0};
  double least_gain = 0.02;  ///< of an effect, lower end of its interval, to be supported
  /// What is being done, and how much of it in 0 … 1.
  std::function<void(const std::string&, double)> progress = {};
};

struct Problem {
  const erp::Robot& robot;
  std::vector<residuals::Episode> episodes;
  DiagnoseOptions options;
  Sets sets;

  void tell(const std::string& what, double share) const {
    if (options.progress) options.progress(what, share);
  }
  LocalizationOptions localization_options() const { return {.seed = options.seed}; }
  /// Progress of a ranking is told as `from` … `to`.
  RankingOptions ranking_options(double from = 0, double to = 0) const;
};

}  // namespace sim::diagnosis
