#pragma once
#include "sim/gap/estimation/search.hpp"

/// Selects the few constants that are far off, while all others are within their tolerances:
///
///   min over F   min over x [data(x) + Σ_{k not in F} x_k² + Σ_{k in F} (x_k²/s_k² + price_k)]
///                + log det A
///
/// F: set of constants far off; s_k: far_sigma; data: linear model of an estimate; A: half the
/// Hessian of the bracket. log det A is Laplace's approximation of the evidence: a wider prior of a
/// constant that the data hardly determine gains nothing.
///
/// Recordings often determine only a product of two constants. A normal prior then divides the
/// deviation between them, and both are wrong. Constants are added to F one at a time while the
/// cost falls. Then a constant is replaced if another costs less, and removed if the cost without
/// it is lower.
/// Source: spike and slab, George and McCulloch 1993; here the most probable set by greedy search.
namespace sim::estimation {

/// The deviation of a constant and its standard error, in tolerances.
struct Deviation {
  std::size_t constant;
  double x, sigma;
};

struct FarOff {
  std::vector<Deviation> all;  ///< the largest first
  std::vector<std::vector<Deviation>>
      alternatives;  ///< for each, alternatives that cost little more
};

/// The deviation as the effect of the library that represents it.
SizedEffect as_effect(const Constant& constant, const Deviation& deviation);

/// Whether a constant that was estimated with the wide prior may stay in F. Without it F costs less
/// if x² (1 − 1/far_sigma²) < price − log far_sigma², because log det A falls by at most log
/// far_sigma².
bool is_worth_far(const Constant& constant, double x);

FarOff far_off(const Uncertain& uncertain, const Estimate& estimate);

}  // namespace sim::estimation
