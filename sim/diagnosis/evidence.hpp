#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sim/diagnosis/split.hpp"
#include "sim/diagnosis/which.hpp"

/// What a diagnosis is asked, and what it has to go by.
namespace sim::diagnosis {

struct DiagnoseOptions {
  std::vector<std::size_t> train, held_out;  ///< recordings; both empty: split by the diagnosis
  std::vector<std::string> withhold;
  int threads = 2;
  std::uint64_t seed = 1;
  std::size_t most_effects = 3;
  /// A stage counts as explained when what is left of its excess is below this …
  double left_excess = 2;
  double search_excess = 1.5;  ///< the same, for another effect to be looked for
  /// … or below this share of what it was. All chosen on development cases.
  double left_share = 0.02;
  /// One effect alone may leave more, for a law of another shape: this share, or this one of the
  /// largest excess.
  double single_left_share = 0.05, single_left_of_most = 0.005;
  double least_gain = 0.02;  ///< of an effect, lower end of its interval, to be supported
  /// What is being done, and how much of it in 0 … 1.
  std::function<void(const std::string&, double)> progress = {};
};

struct Evidence {
  const erp::Robot& robot;
  std::vector<Episode> episodes;
  DiagnoseOptions options;
  Sets sets;

  void tell(const std::string& what, double share) const {
    if (options.progress) options.progress(what, share);
  }
  WhereOptions where_options() const { return {.seed = options.seed}; }
  /// Progress of a ranking is told as `from` … `to`.
  WhichOptions which_options(double from = 0, double to = 0) const;
};

}  // namespace sim::diagnosis
