#pragma once
#include "components/motion_capture/markers.hpp"
#include "sim/model/skeleton/skeleton_model.hpp"

namespace capture {

/// Joints from markers.
///
///   min over q  Σ ‖p_k(q) − z_k‖²/σ² + Σ (q_d ⊖ q_d,predicted)²/σ₀²,    p_k = x_b + R_b m_k
///
/// by Gauss–Newton, ∂p/∂q_d = ω_d × p + v_d from the skeleton's axes. A joint without visible
/// markers keeps its position and gets a large variance: the variances are the diagonal of the
/// inverse normal matrix.
class JointFit {
 public:
  struct Options {
    double noise_m = 0.0005;       ///< σ of a marker's position; chosen
    double prior_sigma_rad = 0.5;  ///< σ₀; chosen large: it matters only without visible markers
  };
  JointFit(const sim::RobotTree& tree, std::vector<Marker> markers, const Options& options);

  /// Fits the joints to the markers, starting at their last or predicted positions. Returns the RMS
  /// residual, in m.
  double fit(const MarkerPoints& measured, std::vector<sim::JointReading>& joints);
  /// Computes joints from bodies with known poses; other joints are unchanged. The poses of bodies
  /// that are fixed to the world are known.
  void from_bodies(const std::vector<std::optional<sim::BodyPose>>& bodies,
                   std::vector<sim::JointReading>& joints) const;

  std::span<const sim::BodyPose> poses(std::span<const sim::JointReading> joints);
  /// Variances of the coordinates after `fit`, in rad².
  const Eigen::VectorXd& variance_rad2() const { return variance_; }
  const sim::SkeletonModel& model() const { return model_; }
  const std::vector<Marker>& markers() const { return markers_; }
  const sim::RobotTree& tree() const { return tree_; }

 private:
  double step(const MarkerPoints& measured, std::vector<sim::JointReading>& joints);

  sim::RobotTree tree_;
  std::vector<Marker> markers_;
  Options options_;
  sim::SkeletonModel model_;
  Eigen::VectorXd variance_;
};

}  // namespace capture
