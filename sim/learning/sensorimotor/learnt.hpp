#pragma once
#include <Eigen/Core>
#include <vector>

/// What the sensorimotor framework learns, and its laws (paper, 5.4 and Fig. 9).
///
/// Unsupervised, from spontaneous twitches: what a muscle does and what is seen to move at the same
/// time are tied to each other (Hebb),
///
///   H ← H + Ṡ Mᵀ dt               senses × muscles
///   Q_jm ∝ H_jm / Σ M_m²          (Fig. 9b), rows scaled to length 1
///
/// so that a muscle which happened to twitch more is not recruited more: with H alone the marker strays
/// across the way to its goal.
///
/// Supervised, from try to try at a goal S* in the senses, of which S' was moved:
///
///   M = Qᵀ (k ⊗ α ⊗ S*)           tendons only pull: what is negative is not recruited
///   e = S* − S',   α_j ← α_j + η e_j S*_j / (S*_j² + ε²)
///
/// k_j, N a sense, is how much force the twitches took to move sense j by one, so that α and η have
/// no unit and α = 1 would do were all linear: k_j = 1 / Σ_m Q_jm (H_jm / Σ M_m²).
namespace sim::sensorimotor {

struct Goal {
  Eigen::VectorXd target;      ///< where, in the senses
  Eigen::VectorXd alpha;       ///< begins at 0: at first nothing is done
  std::vector<double> errors;  ///< |e| by try
};

struct ReachOptions {
  double rate = 0.4;     ///< η; chosen
  double little = 0.01;  ///< ε: goals that are smaller along a sense teach it little; in senses
};

class Learnt {
 public:
  Learnt() = default;
  Learnt(Eigen::Index senses, Eigen::Index muscles)
      : hebb_(Eigen::MatrixXd::Zero(senses, muscles)), squares_(Eigen::VectorXd::Zero(muscles)) {}
  Learnt(Eigen::MatrixXd hebb, Eigen::VectorXd squares)
      : hebb_(std::move(hebb)), squares_(std::move(squares)) {}

  /// What was seen to move by `moved` while muscles did `motors_N` above rest.
  void tie(const Eigen::VectorXd& motors_N, const Eigen::VectorXd& moved) {
    hebb_ += moved * motors_N.transpose();
  }
  /// A twitch has ended that did this.
  void twitched(const Eigen::VectorXd& motors_N) { squares_ += motors_N.cwiseAbs2(); }

  const Eigen::MatrixXd& hebb() const { return hebb_; }
  const Eigen::VectorXd& squares_N2() const { return squares_; }  ///< Σ M² of twitches, by muscle
  /// Rows that nothing moved are zero.
  Eigen::MatrixXd q() const;
  /// k. Zero where nothing moved.
  Eigen::VectorXd force_per_sense_N() const;
  /// M, N above rest, by muscle.
  Eigen::VectorXd motors_N(const Eigen::VectorXd& alpha, const Eigen::VectorXd& goal) const;

 private:
  Eigen::MatrixXd moved_per_N() const;  ///< H_jm / Σ M_m²

  Eigen::MatrixXd hebb_;
  Eigen::VectorXd squares_;
};

/// One try more of a goal: it was to be moved by `wanted` and moved by `moved`.
void learn(Goal& goal, const Eigen::VectorXd& wanted, const Eigen::VectorXd& moved,
           const ReachOptions& options);

}  // namespace sim::sensorimotor
