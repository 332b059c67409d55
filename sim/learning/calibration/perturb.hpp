#pragma once
#include <span>

#include "sim/learning/calibration/parameters.hpp"
#include "sim/learning/calibration/pose_set.hpp"

/// A model that is off by as much as one wants, to try calibrations on.
namespace sim::calibration {

/// Parameters drawn from a normal distribution, then scaled muscle by muscle
///
///   x_k = s_a n_k,   s_a = (Π_j s_j)^(1/J) over the J joints that a's muscle crosses
///
/// until each joint is off the poses by what is asked, on average, to a twentieth. Drawn anew where
/// that would take more than s = 1.5: such a model nobody would begin with.
/// `off_rad` by joint that moves, NaN: any. Throws std::runtime_error where a hundred draws are not
/// off that way.
Eigen::VectorXd perturbed(const Parameters& parameters, std::span<const StillPose> poses,
                          std::span<const double> off_rad, std::uint64_t seed);

}  // namespace sim::calibration
