#pragma once
#include "sim/gap/diagnosis/indistinguishable.hpp"

/// What several effects do together that one alone does.
///
///   left² = |δz|² − bᵀ G⁻¹ b     b = Sᵀ δz, G = Sᵀ S; S: what the parameters of the others change
///
/// The others are found one by one, each next the one that leaves least, and each is let go again
/// where another beside the rest leaves less (sequential replacement: Miller, Subset Selection in
/// Regression, 2002): of those that would do there may be fewer, or others.
namespace sim::diagnosis {

struct ConfounderOptions {
  double share = 0.1;                      ///< of what is hidden, at most left
  std::size_t most = 3;                    ///< others beside each other
  std::vector<std::string> withhold = {};  ///< types of effects that are not looked at
  int threads = 2;
};

/// Of each effect for which others, none of its own type, leave so little: these. The exact ones
/// first. Bus and coarse steps, which change no residual, are in none.
std::vector<Indistinguishable> confounders(const Evaluator& evaluator,
                                           const ConfounderOptions& options);

}  // namespace sim::diagnosis
