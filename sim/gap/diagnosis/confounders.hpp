#pragma once
#include "sim/gap/diagnosis/indistinguishable.hpp"

/// Effects whose change of the residuals equals a sum of changes by several other effects.
///
///   remaining² = |δz|² − bᵀ G⁻¹ b     b = Sᵀ δz, G = Sᵀ S
///
/// δz: change by the effect; S: changes by the parameters of the others. The others are selected
/// one by one, each time the one with the smallest remainder. Each is replaced if another effect in
/// its place has a smaller remainder (sequential replacement: Miller, Subset Selection in
/// Regression, 2002). There may be smaller sets and other sets.
namespace sim::diagnosis {

struct ConfounderOptions {
  double share = 0.1;                      ///< largest remainder, relative to |δz|
  std::size_t most = 3;                    ///< largest number of other effects
  std::vector<std::string> withhold = {};  ///< types of effects that are omitted
  int threads = 2;
};

/// Returns each effect that effects of other types reproduce within `share`, exact matches first.
/// Effects on the bus and quantization change no residual and are not listed.
std::vector<Indistinguishable> confounders(const Evaluator& evaluator,
                                           const ConfounderOptions& options);

}  // namespace sim::diagnosis
