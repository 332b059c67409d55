#pragma once
#include "sim/learning/muscle_networks/perceptron.hpp"
#include "sim/learning/muscle_networks/posture_inputs.hpp"

namespace sim::muscle_networks {

/// Learns corrections to known tendon lengths l_base online, sample by sample:
///
///   l = l_base(q) + Cᵀ φ(x) + noise,    φ(x) = tanh(W x + b) and a constant; W, b random and fixed
///   P = (σ_C/σ_noise)² initially: the correction stays near 0 where there are no samples
///   k = P φ/(λ + φᵀ P φ),   C ← C + k (l − l_base − Cᵀ φ)ᵀ,   P ← (P − k φᵀ P)/λ
///
/// Recursive least squares with forgetting factor λ. All muscles share P, because they share φ. The
/// Jacobian is ∂l_base/∂q + Cᵀ ∂φ/∂x ∂x/∂q. Samples of a posture that has hardly changed are
/// skipped: a robot at rest then does not forget other postures.
class LengthLearner {
 public:
  struct Options {
    int units = 150;
    double forgetting = 1;   ///< λ, per sample
    double move = 0.02;      ///< smallest change of x that counts as a new posture; chosen
    double weight_m = 1e-3;  ///< σ_C, prior standard deviation of the entries of C; chosen
    double noise_m = 3e-4;   ///< σ_noise, of a sample during motion; chosen
    std::uint64_t seed = 1;
  };
  LengthLearner(const PostureInputs& inputs, Eigen::Index muscles, const Options& options);

  /// Adds a sample: path lengths minus l_base, up to a constant per muscle. False: the sample was
  /// skipped. No heap.
  bool add_sample(std::span<const JointReading> joints, const Eigen::VectorXd& correction_m);
  /// Cᵀ ∂φ/∂x ∂x/∂q, to be added to the base's Jacobian. No heap.
  const Eigen::MatrixXd& jacobian(std::span<const JointReading> joints);
  std::size_t samples() const { return samples_; }

 private:
  void compute_features(std::span<const JointReading> joints);

  PostureInputs inputs_;
  Options options_;
  Eigen::MatrixXd weights_;  ///< [W b]
  Eigen::MatrixXd p_, c_;    ///< P; C, units + 1 × muscles
  Eigen::VectorXd x_, last_x_, phi_, gain_, residual_m_;
  Eigen::MatrixXd slopes_, feature_slopes_, jacobian_;
  std::size_t samples_ = 0;
};

}  // namespace sim::muscle_networks
