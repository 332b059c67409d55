#pragma once
#include <Eigen/Core>

#include "sim/learning/calibration/calibration.hpp"

/// Derivatives of a candidate's poses, and of the torques that hold it in the robot's poses, by its
/// parameters.
///
/// A candidate is in equilibrium where τ(q, x) = 0. By the implicit function theorem,
///
///   dq/dx = −(∂τ/∂q)⁻¹ ∂τ/∂x
///
/// Both derivatives are difference quotients at the equilibrium. No equilibrium is searched again.
namespace sim::calibration {

/// Residuals of all poses, one after the other, by coordinate: four per pose on the arm.
struct Residuals {
  Eigen::VectorXd value;
  Eigen::MatrixXd slope;  ///< derivative by x: one column per parameter
};

/// Rotations from the robot's poses to the candidate's equilibria, in rad. Throws like Equilibrium.
Eigen::VectorXd turns_rad(const Candidate& candidate, std::span<const StillPose> poses);
/// The rotations with their derivatives. The pool distributes the parameters over its workers.
Residuals turns(const Parameters& parameters, const Eigen::VectorXd& x,
                std::span<const StillPose> poses, const Pool& pool);

/// τ(q, x) in the robot's poses, in Nm; zero for the robot itself. No equilibrium is searched. The
/// torques are therefore smooth where the equilibrium jumps from one minimum of the potential to
/// another.
Eigen::VectorXd torques_Nm(const Candidate& candidate, std::span<const StillPose> poses);
Residuals torques(const Parameters& parameters, const Eigen::VectorXd& x,
                  std::span<const StillPose> poses, const Pool& pool);

/// Posterior uncertainty of each parameter given the poses.
///
///   remaining² = diag (JᵀJ/σ² + 1)⁻¹      prior of x: standard normal
struct Identified {
  /// Relative to each parameter's spread: 1: undetermined, 0: determined.
  Eigen::VectorXd remaining;
  /// Number of parameter combinations that the poses determine better than the prior.
  int combinations = 0;
};
/// `sigma_rad`: standard deviation of the measured angles.
Identified identified(const Eigen::MatrixXd& slope, double sigma_rad);

}  // namespace sim::calibration
