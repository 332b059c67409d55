#pragma once
#include "sim/gap/residuals/explanation.hpp"

/// Noise at windows in which friction at rest, or a stop, may balance any torque within a band.
namespace sim::residuals {

/// The mean square of the part of noise N(0, 1) beyond a band [−b, b], for a value u that is uniform in the band:
///
///   h(b) = E[(|u + n| − b)₊²] = (P(0) − P(−2b))/b,   P(x) = ((x³ + 3x) Φ(x) + (x² + 2) φ(x))/3
///
/// 1 without a band, 0 for a wide one. `band`: b in standard deviations of the noise.
double noise_beyond(double band);

/// The residual at a window in units of its noise, z² = (r/σ)² + 1 − h(b/σ), with the sign of the residual. The mean
/// square of the noise that the band hides is added, so that a robot with more friction, whose band is wider, does not
/// have a smaller residual.
double normalized(const Residual& residual, std::size_t window, double floor);

}  // namespace sim::residuals
