#pragma once
#include <Eigen/Eigenvalues>
#include <span>
#include <vector>

/// Friction and limits of joints, as impulses at the end of a time step.
///
///   v⁺ = v + W λ,  W = M⁻¹ in joint coordinates
///   friction: λ = −µ dt v⁺ − c,  c = τ_c dt v⁺/|v⁺|, or |c| ≤ τ_c dt where v⁺ = 0
///   limit:    d·v⁺ ≤ gap / dt,  λ along d not positive, and zero where the limit is not reached
///
/// Viscous friction is implicit, so any µ is stable; Coulomb friction holds a joint exactly still
/// while the load stays below τ_c. Of a spherical joint Coulomb friction acts against the angular
/// velocity, with one bound on its size. Solved by block Gauss–Seidel; the problem is convex.
/// Source: Moreau's time stepping; 3.24 of Bullet does nothing with its own members for this.
namespace sim {

struct JointFriction {
  int first = 0, dofs = 1;  ///< 1 or 3 coordinates
  double viscous_Nm_s_per_rad = 0, coulomb_Nm = 0;
};

/// direction·v may not exceed gap / dt.
struct JointLimit {
  int first = 0, dofs = 1;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  double gap_rad = 0;
};

/// Keeps the last impulses as a first guess: part of the state of a simulation.
class JointRows {
 public:
  JointRows(std::vector<JointFriction> frictions, int coordinates);

  bool has_friction() const { return !frictions_.empty(); }
  /// Turns v into v⁺. No heap. Returns the sweeps it took.
  int solve(const Eigen::MatrixXd& w, std::span<const JointLimit> limits, double dt_s,
            Eigen::VectorXd& v);

 private:
  /// The axes in which W of a spherical joint is diagonal.
  using Axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;
  double relax(const JointFriction& friction, Eigen::Vector3d& impulse, const Axes& axes,
               const Eigen::MatrixXd& w, double dt_s, Eigen::VectorXd& v) const;

  std::vector<JointFriction> frictions_;
  std::vector<Eigen::Vector3d> impulses_;
  std::vector<Axes> axes_;
  std::vector<double> limit_impulses_;
};

}  // namespace sim
