#pragma once
#include "sim/gap/settle.hpp"

/// Which constant is far off, by estimates with another one far off in its place.
///
/// The linear model of far_off.hpp does not hold over large deviations: with a centre of mass half as far from its
/// joint, the mass has half its effect, and no mass above 0 seems to explain the same.
namespace sim::gap {

/// Of one or two constants far off each is compared with those that change the residuals most alike, as nominal
/// constants estimated in its place. `found` is `built.estimate`, judged; what costs least is taken into both, and what
/// costs little more added to `built.instead`. `gain`: what the constants far off save.
Found with_rivals_far(const Search& search, Found found, const Evidence& evidence, double gain,
                      AsBuilt& built);

}  // namespace sim::gap
