#pragma once
#include "sim/gap/estimation/completion.hpp"

/// Decides which constant is far off by estimates with another one in its place.
///
/// The linear model of far_off.hpp does not hold over large deviations: with a centre of mass half as far from its
/// joint, the mass has half its effect, and no mass above 0 seems to explain the same.
namespace sim::estimation {

/// If one or two constants are far off, each is set to its nominal value, and a constant with one of the most similar
/// effects on the residuals is estimated as far off instead. The cheapest estimate is stored in `built` and returned;
/// those that cost little more are added to `built.instead`. `found`: `built.estimate` with its cost; `gain`: by how
/// much the constants far off lower the cost.
Found with_rivals_far(const Search& search, Found found, const Problem& problem, double gain,
                      AsBuilt& built);

}  // namespace sim::estimation
