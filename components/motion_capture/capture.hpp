#pragma once
#include <array>
#include <optional>

#include "components/motion_capture/joint_fit.hpp"

/// The paper's stereo infrared-marker system, from two images to joints (paper, 4.4):
///
///   spots in each image  →  epipolar matching, triangulation  →  assignment of points to markers
///   →  joints by least squares over all visible markers
///
/// Points are assigned to markers by the markers' predicted positions; at first, and if too few
/// match, by the distances between a body's markers. Pure: no clock, no bus.
namespace capture {

struct CaptureOptions {
  SpotOptions spots;
  StereoOptions stereo;
  JointFit::Options fit;
  double gate_m = 0.03;               ///< largest distance of a marker from its prediction; chosen
  double lost_m = 0.003;              ///< largest RMS residual of a valid fit; chosen
  std::size_t min_markers = 3;        ///< smallest number of visible markers
  double max_known_sigma_rad = 0.05;  ///< σ above which a joint is unknown; chosen
  double velocity_gain = 0.3;         ///< gain g of the velocity update
};

struct Captured {
  std::vector<sim::JointReading> joints;
  std::vector<bool> known;        ///< by joint; unknown joints keep their prediction
  Eigen::VectorXd variance_rad2;  ///< by coordinate
  std::vector<std::optional<sim::BodyPose>>
      bodies;               ///< poses of bodies with three or more visible markers
  std::size_t markers = 0;  ///< number of visible markers
  double residual_m = 0;    ///< RMS residual of the fit
};

class Capture {
 public:
  Capture(const sim::RobotTree& tree, std::vector<Marker> markers,
          std::array<sim::cameras::Camera, 2> cameras, const CaptureOptions& options);

  /// Processes both images of one instant, `dt_s` after the previous ones. nullopt: the robot was
  /// not found.
  std::optional<Captured> process(const sim::cameras::Image& left, const sim::cameras::Image& right,
                                  double dt_s);
  bool lost() const { return lost_; }
  JointFit& fit() { return fit_; }

 private:
  void predict(double dt_s);
  bool track(std::span<const StereoPoint> points);
  bool search(std::span<const StereoPoint> points);
  bool all_known() const;
  bool fit_joints(const MarkerPoints& measured, std::vector<sim::JointReading> joints);
  void update_velocities(const std::vector<bool>& known_before, double dt_s);
  std::vector<std::optional<sim::BodyPose>> bodies(const MarkerPoints& measured) const;

  std::array<sim::cameras::Camera, 2> cameras_;
  CaptureOptions options_;
  JointFit fit_;
  std::vector<sim::JointReading> joints_, predicted_;
  Captured captured_;
  bool lost_ = true;
};

}  // namespace capture
