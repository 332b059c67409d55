#pragma once
#include "sim/gap/residuals/explanation.hpp"

/// What noise still shows where friction at rest, or a stop, may take anything within a band.
namespace sim::residuals {

/// The mean square of what noise N(0, 1) leaves beyond a band [−b, b] around a value that lies anywhere
/// in it:
///
///   h(b) = E[(|u + n| − b)₊²] = (P(0) − P(−2b))/b,   P(x) = ((x³ + 3x) Φ(x) + (x² + 2) φ(x))/3
///
/// 1 for none, 0 for a wide one. `band`: b in standard deviations of the noise.
double left_of_noise(double band);

/// The residual at a window in units of its noise, z² = (r/σ)² + 1 − h(b/σ), signed as the residual. Noise
/// that a band hides is counted all the same, as it would be in the mean: a robot with more friction, which
/// hides more, gains nothing.
double in_noise(const Residual& residual, std::size_t window, double floor);

}  // namespace sim::residuals
