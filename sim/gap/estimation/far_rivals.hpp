#pragma once
#include "sim/gap/estimation/completion.hpp"

/// Decides which constant is far off by comparison with estimates that have another constant far
/// off instead.
///
/// The linear model of far_off.hpp does not hold over large deviations. If the centre of mass is
/// half as far from its joint, the mass has half its sensitivity, and no mass above 0 seems to
/// explain the same.
namespace sim::estimation {

/// If one or two constants are far off, each is set to its nominal value, and a constant with a
/// similar sensitivity is estimated as far off instead. The cheapest estimate is stored in `built`
/// and returned. Those that cost little more are added to `built.alternatives`. `found`:
/// `built.estimate` with its cost; `gain`: decrease of the cost by the constants far off.
JudgedEstimate with_rivals_far(const Search& search, JudgedEstimate found, const Problem& problem,
                               double gain, AsBuilt& built);

}  // namespace sim::estimation
