#pragma once
#include "sim/gap/estimation/completion.hpp"

/// Which constant is far off: estimates with another one far off in its place.
///
/// The linear model of far_off.hpp does not hold over large deviations: with a centre of mass half as far from its
/// joint, the mass has half its effect, and no mass above 0 seems to explain the same.
namespace sim::estimation {

/// Where one or two constants are far off: each is set to its nominal value, and one of those with the most similar
/// effect on the residuals is estimated as far off instead. The cheapest estimate is taken into `built` and returned;
/// those that cost little more are added to `built.instead`. `found`: `built.estimate`, judged; `gain`: by how much the
/// constants far off lower the cost.
Found with_rivals_far(const Search& search, Found found, const Problem& problem, double gain,
                      AsBuilt& built);

}  // namespace sim::estimation
