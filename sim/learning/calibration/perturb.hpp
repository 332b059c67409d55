#pragma once
#include <span>

#include "sim/learning/calibration/parameters.hpp"
#include "sim/learning/calibration/pose_set.hpp"

/// Makes a model with a chosen error, to test calibrations.
namespace sim::calibration {

/// Parameters drawn from a normal distribution, then scaled muscle by muscle
///
///   x_k = s_a n_k,   s_a = (Π_j s_j)^(1/J) over the J joints that a's muscle crosses
///
/// until the mean error of each joint over the poses is within 5 % of the requested one. If this
/// needs s > 1.5, the model is implausible, and the parameters are drawn again. `off_rad`:
/// requested error of each movable joint; NaN: any. Throws std::runtime_error if a hundred draws
/// fail.
Eigen::VectorXd perturbed(const Parameters& parameters, std::span<const StillPose> poses,
                          std::span<const double> off_rad, std::uint64_t seed);

}  // namespace sim::calibration
