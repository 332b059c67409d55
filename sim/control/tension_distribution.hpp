#pragma once
#include <Eigen/Core>

#include "interfaces/robot/robot.hpp"
#include "sim/control/box_qp.hpp"

/// Tension distribution: tensions that produce desired joint torques (paper, eq. 8 and 5.3):
///
///   min ½ Σ g_a (f_a − f°_a)² + ½ ρ |Lᵀ f + τ|²,   low ≤ f ≤ high
///
/// L = ∂l/∂q. There are more tendons than joints. The first sum selects one of all solutions that
/// produce τ:
///
///   least_tension      g = 1,                 f° = low
///   least_energy       g = R (r / η N K_T)²,  f° = 0     heat in the windings, W/N²
///   least_activation   g = 1 / high²,         f° = 0     relative to the largest tension
///   smooth             g = 1,                 f° = the previous tensions
///
/// ρ is chosen such that a feasible τ is produced with a relative error of about 1e-5. If τ is
/// infeasible because of bounds or a joint without a tendon, the result minimises |Lᵀ f + τ|. No
/// heap after construction.
namespace sim {

enum class TensionObjective { least_tension, least_energy, least_activation, smooth };

/// Terms of the objective, by actuator; weights of any scale, tensions in N.
struct ObjectiveTerms {
  Eigen::VectorXd weight, preferred_N, low_N, high_N;
  bool previous_is_preferred = false;  ///< f° is the previous result; at first, `preferred_N`
};

/// `least_N`: lower bound of every tension, which keeps the tendons taut. The upper bound is
/// max_tension_N of robot.xml. Throws std::invalid_argument, with the actuator's name, if the lower
/// bound is not below the upper one.
ObjectiveTerms objective_terms(const erp::Robot& robot, TensionObjective objective, double least_N);

class TensionDistribution {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  TensionDistribution(const ObjectiveTerms& terms, int coordinates);

  /// f, N, by actuator, for τ by coordinate (Nm; N for free bodies); `l`: actuators × coordinates.
  /// Valid until the next call.
  const Vector& distribute(const Matrix& l, const Vector& torque);
  /// Lᵀ f + τ of the last result: the negative of the torque error.
  const Vector& missing() const { return residual_; }
  /// Fixes the tension of one actuator, for example of a failed one. A negative value restores its
  /// bounds.
  void fix(int actuator, double tension_N);
  int changes() const { return qp_.changes(); }
  bool converged() const { return qp_.converged(); }

 private:
  ObjectiveTerms terms_;
  Vector low_, high_, c_, tension_, residual_;
  Matrix h_;
  BoxQp qp_;
};

}  // namespace sim
