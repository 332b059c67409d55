#pragma once
#include "sim/learning/muscle_networks/perceptron.hpp"
#include "sim/learning/muscle_networks/posture_inputs.hpp"

namespace sim::muscle_networks {

/// Tendon lengths learnt on line, sample by sample, beside a base that is already known:
///
///   l = l_base(q) + Cᵀ φ(x) + noise,    φ(x) = tanh(W x + b) and a constant; W, b drawn once
///   P = (σ_C/σ_noise)² at first, so that C stays at the base where nothing has been seen
///   k = P φ/(λ + φᵀ P φ),   C ← C + k (l − l_base − Cᵀ φ)ᵀ,   P ← (P − k φᵀ P)/λ
///
/// Recursive least squares with forgetting λ; one P serves all muscles, which see the same φ. So
/// the Jacobian is ∂l_base/∂q + Cᵀ ∂φ/∂x ∂x/∂q. A posture that has hardly moved teaches nothing new
/// and is left out, so that resting does not forget.
class LengthLearner {
 public:
  struct Options {
    int units = 150;
    double forgetting = 1;   ///< λ, a sample
    double move = 0.02;      ///< of x: what is a new posture; chosen
    double weight_m = 1e-3;  ///< σ_C, what entries of C are expected to be: beside a base; chosen
    double noise_m = 3e-4;   ///< σ_noise, of a sample on the move; chosen
    std::uint64_t seed = 1;
  };
  LengthLearner(const PostureInputs& inputs, Eigen::Index muscles, const Options& options);

  /// One sample: the path lengths less those of the base, up to a constant a muscle. False: left
  /// out. No heap.
  bool hear(std::span<const JointReading> joints, const Eigen::VectorXd& beside_base_m);
  /// What is to be added to the base's Jacobian. No heap.
  const Eigen::MatrixXd& jacobian(std::span<const JointReading> joints);
  std::size_t samples() const { return samples_; }

 private:
  void bend(std::span<const JointReading> joints);

  PostureInputs inputs_;
  Options options_;
  Eigen::MatrixXd weights_;  ///< [W b]
  Eigen::MatrixXd p_, c_;    ///< P; C, units + 1 × muscles
  Eigen::VectorXd x_, last_x_, phi_, gain_, left_m_;
  Eigen::MatrixXd slopes_, bends_, jacobian_;
  std::size_t samples_ = 0;
};

}  // namespace sim::muscle_networks
