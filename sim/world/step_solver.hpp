#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "sim/world/envelope_cholesky.hpp"

/// The velocities at the end of a time step, as the least of one convex function:
///
///   v⁺ = argmin ½ vᵀ H v − pᵀ v + dt Σ_k f_k(v)² / 2 G_k + dt Σ_j (½ µ_j |v_j|² + c_j |v_j|)
///   f_k(v) = max(0, a_k + G_k J_k v)
///
/// whose gradient is the balance of momentum: H v⁺ = p less the impulses of the forces f_k along
/// J_k (tendons, which only pull; limits, which only push) and of the joints' friction, viscous µ
/// and Coulomb c, the latter within its bound where the joint is still. All are implicit in v⁺:
/// stable for any G, µ, c. A joint that sticks is exactly still. Of a spherical joint the Coulomb
/// friction acts against the angular velocity, with one bound on its size.
///
/// Solved by Newton's method: where no force begins or ends and no joint starts or stops, the
/// function is quadratic but for turning ball joints, and one step is exact. A joint that would
/// turn back within a step stops first; one that others would push the wrong way stays; a step is
/// halved until the function does not rise at its end.
/// Source: Moreau's time stepping as convex optimisation (Anitescu, Hart 2004; Todorov 2014).
namespace sim {

/// A force that acts one way along a row of coordinates: f = max(0, a + G J v).
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

/// Makes it one that stops: it lets J v⁺ come to gap/dt and no farther, up to 10⁻⁷ of the speed it
/// takes from `inertia` (kg, or kg m²) alone. A fifth of an overrun (gap < 0) is undone a step;
/// chosen.
inline void hold_back(double gap, double inertia, double dt_s, OneSidedForce& force) {
  constexpr double hardness = 1e7, undone_a_step = 0.2;
  force.gain_N_s_per_m = hardness * inertia / dt_s;
  force.start_N = -force.gain_N_s_per_m * (gap >= 0 ? gap : undone_a_step * gap) / dt_s;
}

struct JointFriction {
  int first = 0, dofs = 1;  ///< 1 or 3 coordinates
  double viscous_Nm_s_per_rad = 0, coulomb_Nm = 0;
};

class StepSolver {
 public:
  /// `forces`: the most there will be.
  StepSolver(int coordinates, int forces, std::vector<JointFriction> frictions);

  /// Of the friction given as the n-th; before `begin`.
  void set_coulomb(std::size_t n, double coulomb_Nm) { frictions_[n].coulomb_Nm = coulomb_Nm; }
  /// A new posture: H and the forces; kept by reference until the last `solve` of the step.
  void begin(const Eigen::MatrixXd& h, std::span<const OneSidedForce> forces, double dt_s);
  /// Moves v near v⁺ for the momentum p = H v + dt τ: Newton's first step, unchecked.
  void approach(const Eigen::VectorXd& p, Eigen::VectorXd& v);
  /// v⁺ for that momentum. `v`: a first guess, then the answer. No heap.
  /// Returns false if it did not settle in so many of Newton's steps.
  bool solve(const Eigen::VectorXd& p, Eigen::VectorXd& v, int most_steps = 100);
  /// f_k at the answer.
  std::span<const double> forces_N() const { return {force_N_.data(), forces_.size()}; }

 private:
  void differentiate(const Eigen::VectorXd& p, const Eigen::VectorXd& v);
  void rub(std::size_t joint, const Eigen::VectorXd& v);
  void stiffen();
  void factor();
  void add_friction(std::size_t joint);
  void aim(const Eigen::VectorXd& v);
  bool go(double share, Eigen::VectorXd& v) const;
  bool descend(const Eigen::VectorXd& p, Eigen::VectorXd& v);

  std::vector<JointFriction> frictions_;
  const Eigen::MatrixXd* h_ = nullptr;
  std::span<const OneSidedForce> forces_;
  double dt_s_ = 0;
  std::vector<double> force_N_;
  struct Sliding {
    Eigen::Vector3d way = Eigen::Vector3d::Zero();  ///< v/|v|; zero: it is still
    double speed = 0;                               ///< |v|; of one that starts, how fast it may
  };
  std::vector<Sliding> joints_, start_;   ///< at the last gradient; where the step began
  std::vector<char> pattern_, factored_;  ///< which forces act, which joints slide, which way
  double largest_ = 0;                    ///< impulse of the balance
  bool curved_ = false;                   ///< a ball joint slides: not quadratic there
  Eigen::MatrixXd stiff_, system_;
  Eigen::VectorXd gradient_, step_, before_;
  EnvelopeCholesky factor_;
};

}  // namespace sim
