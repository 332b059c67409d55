#pragma once
#include <Eigen/Core>

#include "interfaces/robot/robot.hpp"
#include "sim/control/box_qp.hpp"

/// Which tensions turn the joints as they shall turn (paper, eq. 8 and 5.3):
///
///   min ½ Σ g_a (f_a − f°_a)² + ½ ρ |Lᵀ f + τ|²,   low ≤ f ≤ high
///
/// L = ∂l/∂q; there are more tendons than joints, and the first sum says which of all the tensions
/// that give τ are liked best:
///
///   least_tension      g = 1,                 f° = low
///   least_energy       g = R (r / η N K_T)²,  f° = 0     heat in the windings, W/N²
///   least_activation   g = 1 / high²,         f° = 0     the shares of what each tendon may pull
///   smooth             g = 1,                 f° = the tensions before
///
/// ρ is so large that tensions which can give τ miss it by some 1e-5 of themselves. Where bounds,
/// or a joint that no tendon turns, leave none, the answer is the nearest torque, |Lᵀ f + τ| least.
/// No heap after construction.
namespace sim {

enum class Liking { least_tension, least_energy, least_activation, smooth };

/// By actuator; weights of any scale, tensions in N.
struct Likes {
  Eigen::VectorXd weight, liked_N, low_N, high_N;
  bool as_before = false;  ///< f° is the answer before; `liked_N` that of the first
};

/// `least_N`: what every tendon pulls at least, so that none goes slack; the most is robot.xml's
/// max_tension_N. Throws std::invalid_argument where that leaves nothing, naming the actuator.
Likes likes_of(const erp::Robot& robot, Liking liking, double least_N);

class TensionShare {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  TensionShare(const Likes& likes, int coordinates);

  /// f, N, by actuator, for τ by coordinate (Nm; of free bodies N); `l`: actuators × coordinates.
  /// Valid until the next call.
  const Vector& share(const Matrix& l, const Vector& torque);
  /// Lᵀ f + τ of the last answer: what is missing to the torque, with its sign turned.
  const Vector& missing() const { return missing_; }
  /// A tendon that shall pull with so much, whatever the others do: one that is lost, say. Negative:
  /// within its bounds again.
  void fix(int actuator, double tension_N);
  int changes() const { return qp_.changes(); }
  bool settled() const { return qp_.settled(); }

 private:
  Likes likes_;
  Vector low_, high_, c_, tension_, missing_;
  Matrix h_;
  BoxQp qp_;
};

}  // namespace sim
