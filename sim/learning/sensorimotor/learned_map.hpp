#pragma once
#include <Eigen/Core>
#include <vector>

/// The map that the sensorimotor framework learns, and its laws (paper, 5.4 and Fig. 9).
///
/// Unsupervised, from spontaneous twitches: the force of a muscle is associated with the
/// simultaneous motion of the senses (Hebb),
///
///   H ← H + Ṡ Mᵀ dt               senses × muscles
///   Q_jm ∝ H_jm / Σ M_m²          (Fig. 9b), rows scaled to length 1
///
/// The division by Σ M_m² makes recruitment independent of the number of twitches of a muscle. With
/// H alone the marker deviates sideways on its path to the goal.
///
/// Supervised, from trial to trial at a goal S* in the senses, where S' is the motion achieved:
///
///   M = Qᵀ (k ⊗ α ⊗ S*)           tendons only pull: negative forces are set to 0
///   e = S* − S',   α_j ← α_j + η e_j S*_j / (S*_j² + ε²)
///
/// k_j, in N per sense, is the force that the twitches needed to move sense j by one. α and η are
/// therefore dimensionless, and α = 1 reaches the goal of a linear robot: k_j = 1 / Σ_m Q_jm (H_jm
/// / Σ M_m²).
namespace sim::sensorimotor {

struct Goal {
  Eigen::VectorXd target;      ///< target, in the senses
  Eigen::VectorXd alpha;       ///< gain of each sense; starts at 0
  std::vector<double> errors;  ///< |e| of each trial
};

/// η and ε; described in Experiment.
struct ReachOptions {
  double rate = 0.4;
  double regularization = 0.01;
};

class LearnedMap {
 public:
  LearnedMap() = default;
  LearnedMap(Eigen::Index senses, Eigen::Index muscles)
      : hebb_(Eigen::MatrixXd::Zero(senses, muscles)), squares_(Eigen::VectorXd::Zero(muscles)) {}
  LearnedMap(Eigen::MatrixXd hebb, Eigen::VectorXd squares)
      : hebb_(std::move(hebb)), squares_(std::move(squares)) {}

  /// Associates forces `motors_N` above rest with the motion `motion` of the senses.
  void associate(const Eigen::VectorXd& motors_N, const Eigen::VectorXd& motion) {
    hebb_ += motion * motors_N.transpose();
  }
  /// Records the forces of a twitch that has ended.
  void twitched(const Eigen::VectorXd& motors_N) { squares_ += motors_N.cwiseAbs2(); }

  const Eigen::MatrixXd& hebb() const { return hebb_; }
  const Eigen::VectorXd& squares_N2() const { return squares_; }  ///< Σ M² of twitches, by muscle
  /// Rows of senses that no twitch moved are zero.
  Eigen::MatrixXd q() const;
  /// k. Zero for senses that no twitch moved.
  Eigen::VectorXd force_per_sense_N() const;
  /// M by muscle, in N above rest.
  Eigen::VectorXd motors_N(const Eigen::VectorXd& alpha, const Eigen::VectorXd& goal) const;

 private:
  Eigen::MatrixXd motion_per_N() const;  ///< H_jm / Σ M_m²

  Eigen::MatrixXd hebb_;
  Eigen::VectorXd squares_;
};

/// Updates a goal after one trial: `desired` is the commanded motion of the senses, `motion` the
/// measured one.
void learn(Goal& goal, const Eigen::VectorXd& desired, const Eigen::VectorXd& motion,
           const ReachOptions& options);

}  // namespace sim::sensorimotor
