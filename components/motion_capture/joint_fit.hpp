#pragma once
#include "components/motion_capture/markers.hpp"
#include "sim/model/skeleton/skeleton_model.hpp"

namespace capture {

/// Joints from markers.
///
///   min over q  Σ ‖p_k(q) − z_k‖²/σ² + Σ (q_d ⊖ q_d before)²/σ₀²,    p_k = x_b + R_b m_k
///
/// by Gauss–Newton, ∂p/∂q_d = ω_d × p + v_d from the skeleton's axes. A joint that no marker tells
/// of stays where it was, and its variance says so: the inverse of the normal matrix.
class JointFit {
 public:
  struct Options {
    double noise_m = 0.0005;  ///< σ of a marker's place; chosen
    double before_rad = 0.5;  ///< σ₀; chosen: wide, so that it only decides where markers do not
  };
  JointFit(const sim::RobotTree& tree, std::vector<Marker> markers, const Options& options);

  /// From the joints' last or expected positions to where the markers say they are. Returns the RMS
  /// of what is left, m.
  double fit(const Sightings& seen, std::vector<sim::JointReading>& joints);
  /// Joints from bodies whose poses are known; the others stay. Bodies fixed to the world are known.
  void from_bodies(const std::vector<std::optional<sim::BodyPose>>& bodies,
                   std::vector<sim::JointReading>& joints) const;

  std::span<const sim::BodyPose> poses(std::span<const sim::JointReading> joints);
  /// Of the coordinates after `fit`, rad².
  const Eigen::VectorXd& variance_rad2() const { return variance_; }
  const sim::SkeletonModel& model() const { return model_; }
  const std::vector<Marker>& markers() const { return markers_; }
  const sim::RobotTree& tree() const { return tree_; }

 private:
  double step(const Sightings& seen, std::vector<sim::JointReading>& joints);

  sim::RobotTree tree_;
  std::vector<Marker> markers_;
  Options options_;
  sim::SkeletonModel model_;
  Eigen::VectorXd variance_;
};

}  // namespace capture
