#pragma once
#include "sim/gap/estimation/search.hpp"

/// Which few constants are far off, where all others are as building leaves them.
///
///   min over F   min over x [data(x) + Σ_{k not in F} x_k² + Σ_{k in F} (x_k²/20² + price_k)] + log det A
///
/// A: half the Hessian of the bracket. log det A: a constant that the data hardly determine gains nothing by
/// more room (Laplace's approximation of the evidence).
///
/// What two constants make together is often all that recordings determine, and a prior alone then shares
/// the deviation between them: neither is right. data: the linear model of an estimate. Constants join F
/// one at a time while the cost falls; then each gives way to a better one, or goes where it has come to cost more
/// than it saves.
/// Source: spike and slab, George and McCulloch 1993; here the most probable set by greedy search.
namespace sim::estimation {

/// One constant as it would be: in tolerances.
struct Deviation {
  std::size_t constant;
  double x, sigma;
};

struct FarOff {
  std::vector<Deviation> all;                   ///< the farthest first
  std::vector<std::vector<Deviation>> instead;  ///< of each: alternatives that cost little more
};

/// As the effect of the library that is such a change.
Sized as_effect(const Constant& constant, const Deviation& deviation);

/// Whether a constant can be worth its place in F where it was estimated with that room: F costs less without one
/// at x if x² (1 − 1/far²) < price − log far², for log det A falls by at most log far².
bool is_worth_far(const Constant& constant, double x);

FarOff far_off(const Uncertain& uncertain, const Estimate& estimate);

}  // namespace sim::estimation
