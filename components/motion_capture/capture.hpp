#pragma once
#include <array>
#include <optional>

#include "components/motion_capture/joint_fit.hpp"

/// The paper's stereo infrared-marker system, from two images to joints (paper, 4.4):
///
///   spots in each image  →  epipolar matching, triangulation  →  which point is which marker
///   →  joints by least squares over all markers seen
///
/// Which marker is which follows from where each is expected; at first, and where that tells too
/// little, from the distances between a body's markers. Pure: no clock, no bus.
namespace capture {

struct CaptureOptions {
  SpotOptions spots;
  StereoOptions stereo;
  JointFit::Options fit;
  double gate_m = 0.03;     ///< how far from where it is expected a marker is looked for
  double lost_m = 0.003;    ///< what may be left of a good fit, RMS
  std::size_t least = 3;    ///< markers in view below which it is lost
  double known_rad = 0.05;  ///< σ above which the markers in view do not tell a joint; chosen
  double follow = 0.3;      ///< share of a surprise that the velocities take up
};

struct Captured {
  std::vector<sim::JointReading> joints;
  std::vector<bool> known;        ///< by joint; the others are only where they are expected
  Eigen::VectorXd variance_rad2;  ///< by coordinate
  std::vector<std::optional<sim::BodyPose>>
      bodies;               ///< those of three markers seen, each by itself
  std::size_t markers = 0;  ///< seen
  double left_m = 0;        ///< RMS of the fit
};

class Capture {
 public:
  Capture(const sim::RobotTree& tree, std::vector<Marker> markers,
          std::array<sim::cameras::Camera, 2> cameras, const CaptureOptions& options);

  /// Both images of one instant, `dt_s` after the ones before. Nothing: the robot is not found.
  std::optional<Captured> see(const sim::cameras::Image& left, const sim::cameras::Image& right,
                              double dt_s);
  bool lost() const { return lost_; }
  JointFit& fit() { return fit_; }

 private:
  void expect(double dt_s);
  bool track(std::span<const StereoPoint> points);
  bool search(std::span<const StereoPoint> points);
  bool all_known() const;
  bool accept(const Sightings& seen, std::vector<sim::JointReading> joints);
  void learn_speed(const std::vector<bool>& known_before, double dt_s);
  std::vector<std::optional<sim::BodyPose>> bodies(const Sightings& seen) const;

  std::array<sim::cameras::Camera, 2> cameras_;
  CaptureOptions options_;
  JointFit fit_;
  std::vector<sim::JointReading> joints_, expected_;
  Captured captured_;
  bool lost_ = true;
};

}  // namespace capture
