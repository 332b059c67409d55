#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "sim/world/envelope_cholesky.hpp"

/// The velocities at the end of a time step, as the minimiser of one convex function:
///
///   v⁺ = argmin ½ vᵀ H v − pᵀ v + dt Σ_k f_k(v)² / 2 G_k + dt Σ_j (½ µ_j |v_j|² + c_j |v_j|)
///   f_k(v) = max(0, a_k + G_k J_k v)
///
/// whose gradient is the balance of momentum: H v⁺ = p minus the impulses of the forces f_k along
/// J_k (tendons, which only pull; limits, which only push) and of the joints' friction, viscous µ
/// and Coulomb c. The Coulomb friction of a joint at rest may have any value within its bound. All
/// are implicit in v⁺ and therefore stable for any G, µ, c. A sticking joint has velocity exactly
/// zero. The Coulomb friction of a spherical joint acts against the angular velocity, with one
/// bound on its magnitude.
///
/// Solved by Newton's method. Where no force and no joint changes its state, the function is
/// quadratic, except for rotating ball joints, and one step is exact. A joint whose velocity would
/// reverse within a step stops first. A joint that other joints would push against its starting
/// direction stays at rest. A step is halved until the function does not increase at its end.
/// Source: Moreau's time stepping as convex optimisation (Anitescu, Hart 2004; Todorov 2014).
namespace sim {

/// A force that acts in one direction along a row of coordinates: f = max(0, a + G J v).
struct OneSidedForce {
  struct Term {
    int coordinate;
    double slope;
  };
  double start_N = 0;         ///< a
  double gain_N_s_per_m = 0;  ///< G > 0
  std::vector<Term> row;      ///< J, its entries that are not zero
  double along(const Eigen::VectorXd& v) const {
    double speed = 0;
    for (const Term& term : row) speed += term.slope * v[term.coordinate];
    return speed;
  }
};

/// Makes the force a stop: it limits J v⁺ to gap/dt. The limit is exceeded by 10⁻⁷ of the speed
/// that the force removes from a free `inertia` (kg, or kg m²). A fifth of an overrun (gap < 0) is
/// corrected per step; both values are chosen.
inline void set_stop(double gap, double inertia, double dt_s, OneSidedForce& force) {
  constexpr double relative_gain = 1e7, corrected_per_step = 0.2;
  force.gain_N_s_per_m = relative_gain * inertia / dt_s;
  force.start_N = -force.gain_N_s_per_m * (gap >= 0 ? gap : corrected_per_step * gap) / dt_s;
}

struct JointFriction {
  int first = 0, dofs = 1;  ///< 1 or 3 coordinates
  double viscous_Nm_s_per_rad = 0, coulomb_Nm = 0;
};

class StepSolver {
 public:
  /// `forces`: the largest number of forces.
  StepSolver(int coordinates, int forces, std::vector<JointFriction> frictions);

  /// Sets the Coulomb friction of element n of the constructor's `frictions`. Call it before
  /// `begin`.
  void set_coulomb(std::size_t n, double coulomb_Nm) { frictions_[n].coulomb_Nm = coulomb_Nm; }
  /// Sets a new posture: H and the forces. Both must stay valid until the last `solve` of the step.
  void begin(const Eigen::MatrixXd& h, std::span<const OneSidedForce> forces, double dt_s);
  /// Moves v close to v⁺ for the momentum p = H v + dt τ: Newton's first step, without a check of
  /// convergence.
  void approach(const Eigen::VectorXd& p, Eigen::VectorXd& v);
  /// v⁺ for that momentum. `v`: initial guess, then the solution. No heap.
  /// Returns false if it did not converge in `max_steps` Newton steps.
  bool solve(const Eigen::VectorXd& p, Eigen::VectorXd& v, int max_steps = 100);
  /// f_k at the solution.
  std::span<const double> forces_N() const { return {force_N_.data(), forces_.size()}; }

 private:
  void differentiate(const Eigen::VectorXd& p, const Eigen::VectorXd& v);
  void evaluate_friction(std::size_t joint, const Eigen::VectorXd& v);
  void assemble_stiffness();
  void factor();
  void add_friction(std::size_t joint);
  void compute_step(const Eigen::VectorXd& v);
  bool advance(double fraction, Eigen::VectorXd& v) const;
  bool descend(const Eigen::VectorXd& p, Eigen::VectorXd& v);

  std::vector<JointFriction> frictions_;
  const Eigen::MatrixXd* h_ = nullptr;
  std::span<const OneSidedForce> forces_;
  double dt_s_ = 0;
  std::vector<double> force_N_;
  struct Sliding {
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< v/|v|; zero: at rest
    double speed = 0;  ///< |v|; if starting, the largest possible speed
  };
  std::vector<Sliding> joints_, start_sliding_;  ///< at the last gradient; at the start of the step
  std::vector<char> pattern_,
      factored_pattern_;             ///< active forces; sliding joints and their direction
  double largest_impulse_ = 0;       ///< largest impulse in the balance
  bool has_rotating_joint_ = false;  ///< a ball joint slides: the function is not quadratic
  Eigen::MatrixXd stiffness_, system_;
  Eigen::VectorXd gradient_, step_, start_velocity_;
  EnvelopeCholesky factor_;
};

}  // namespace sim
