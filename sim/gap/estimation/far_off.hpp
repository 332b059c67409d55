#pragma once
#include "sim/gap/estimation/search.hpp"

/// Which few constants are far off, while all others are within their tolerances.
///
///   min over F   min over x [data(x) + Σ_{k not in F} x_k² + Σ_{k in F} (x_k²/20² + price_k)] + log det A
///
/// A: half the Hessian of the bracket. log det A (Laplace's approximation of the evidence): a constant that the data
/// hardly determine gains nothing from a wider prior.
///
/// Recordings often determine only a product of two constants, and a prior alone then divides the deviation between
/// them: neither is right. data: the linear model of an estimate. Constants are added to F one at a time while the cost
/// falls; then each is replaced if another costs less, and removed if it costs more than it saves.
/// Source: spike and slab, George and McCulloch 1993; here the most probable set by greedy search.
namespace sim::estimation {

/// The deviation of a constant and its standard error, in tolerances.
struct Deviation {
  std::size_t constant;
  double x, sigma;
};

struct FarOff {
  std::vector<Deviation> all;                   ///< the largest first
  std::vector<std::vector<Deviation>> instead;  ///< for each, alternatives that cost little more
};

/// The deviation as the effect of the library that represents it.
Sized as_effect(const Constant& constant, const Deviation& deviation);

/// Whether a constant that was estimated with the wide prior may stay in F. Without it F costs less if
/// x² (1 − 1/far²) < price − log far², for log det A falls by at most log far².
bool is_worth_far(const Constant& constant, double x);

FarOff far_off(const Uncertain& uncertain, const Estimate& estimate);

}  // namespace sim::estimation
