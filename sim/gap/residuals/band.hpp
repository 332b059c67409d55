#pragma once
#include "sim/gap/residuals/explanation.hpp"

/// Noise of residuals at windows in which friction at rest, or a stop, may balance any torque
/// within a band.
namespace sim::residuals {

/// The mean square of the part of noise n ~ N(0, 1) beyond a band [−b, b], for a value u that is
/// uniform in the band:
///
///   h(b) = E[(|u + n| − b)₊²] = (P(0) − P(−2b))/b,   P(x) = ((x³ + 3x) Φ(x) + (x² + 2) φ(x))/3
///
/// φ, Φ: density and distribution function of N(0, 1). h(0) = 1, h(∞) = 0. `band`: b, in standard
/// deviations.
double noise_beyond(double band);

/// The residual r at a window in units of its noise, with the sign of r:
///
///   z² = (r/σ)² + 1 − h(b/σ)      σ: `floor`, b: the band at the window
///
/// The last terms add the noise that the band hides. Without them a robot with more friction, and
/// thus a wider band, would have a smaller residual.
double normalized(const Residual& residual, std::size_t window, double floor);

}  // namespace sim::residuals
