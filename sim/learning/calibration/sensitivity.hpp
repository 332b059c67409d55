#pragma once
#include <Eigen/Core>

#include "sim/learning/calibration/calibration.hpp"

/// How a candidate's poses turn with its parameters, and what it would take to hold it where the
/// robot stood.
///
/// A candidate rests where τ(q, x) = 0. So, by the implicit function theorem,
///
///   dq/dx = −(∂τ/∂q)⁻¹ ∂τ/∂x
///
/// with both slopes by difference quotients at rest: no pose need be searched anew.
namespace sim::calibration {

/// Over all poses, one after the other, by coordinates: four a pose on the arm.
struct Residuals {
  Eigen::VectorXd value;
  Eigen::MatrixXd slope;  ///< by x: a column a parameter
};

/// From where the robot was to where the candidate rests, rad. Throws as Equilibrium.
Eigen::VectorXd turns_rad(const Candidate& candidate, std::span<const StillPose> poses);
/// With slopes; the pool shares out the parameters.
Residuals turns(const Parameters& parameters, const Eigen::VectorXd& x,
                std::span<const StillPose> poses, const Pool& pool);

/// τ(q, x) where the robot was, Nm: zero for the robot itself. No pose is searched, so these are
/// smooth where rests jump from one hollow to another.
Eigen::VectorXd torques_Nm(const Candidate& candidate, std::span<const StillPose> poses);
Residuals torques(const Parameters& parameters, const Eigen::VectorXd& x,
                  std::span<const StillPose> poses, const Pool& pool);

/// What the poses leave open of each parameter.
///
///   left² = diag (JᵀJ/σ² + 1)⁻¹      prior: standard normal, as x is
struct Identified {
  Eigen::VectorXd left;  ///< of each parameter's spread: 1 – the poses say nothing, 0 – all
  int combinations = 0;  ///< of parameters that they say more of than the prior
};
/// `sigma_rad`: how well angles are known and followed.
Identified identified(const Eigen::MatrixXd& slope, double sigma_rad);

}  // namespace sim::calibration
