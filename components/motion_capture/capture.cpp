#include "components/motion_capture/capture.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/skeleton/joint_path.hpp"

namespace capture {

constexpr std::size_t min_markers_of_pose = 3;  // three points determine a rigid pose

using sim::BodyPose;
using sim::JointReading;
using sim::Vec3;

Capture::Capture(const sim::RobotTree& tree, std::vector<Marker> markers,
                 std::array<sim::cameras::Camera, 2> cameras, const CaptureOptions& options)
    : cameras_(std::move(cameras)), options_(options), fit_(tree, std::move(markers), options.fit) {
  for (const erp::Joint& joint : tree.joints) joints_.push_back(sim::initial_reading(joint));
}

std::optional<Captured> Capture::process(const sim::cameras::Image& left,
                                         const sim::cameras::Image& right, double dt_s) {
  const auto points = triangulate(cameras_[0], find_spots(left, options_.spots), cameras_[1],
                                  find_spots(right, options_.spots), options_.stereo);
  predict(dt_s);
  const std::vector<bool> known_before = lost_ ? std::vector<bool>{} : captured_.known;
  const bool tracked = !lost_ && track(points);
  const bool all_tracked = tracked && all_known();
  const bool is_located = all_tracked || search(points) || tracked;
  if (is_located) update_velocities(known_before, dt_s);
  lost_ = !is_located;
  if (!is_located) return std::nullopt;
  joints_ = captured_.joints;
  return captured_;
}

/// Predicts the joints with constant velocity.
void Capture::predict(double dt_s) {
  predicted_ = joints_;
  for (JointReading& joint : predicted_) {
    std::array<double, 3> rotation_rad = joint.velocity_rad_per_s;
    for (double& angle : rotation_rad) angle *= dt_s;
    joint.position = sim::displaced(joint.type, joint.position, rotation_rad);
  }
}

bool Capture::track(std::span<const StereoPoint> points) {
  return fit_joints(assign_nearest(fit_.markers(), fit_.poses(predicted_), points, options_.gate_m),
                    predicted_);
}

bool Capture::all_known() const {
  return std::ranges::all_of(captured_.known, [](bool is_known) { return is_known; });
}

/// Finds each body by the distances between its markers.
bool Capture::search(std::span<const StereoPoint> points) {
  constexpr double tolerance_m = 0.004;  // chosen: of a marker from its point
  std::vector<std::optional<BodyPose>> poses(fit_.tree().bodies.size());
  for (std::size_t b = 0; b < poses.size(); ++b) {
    std::vector<Vec3> body_markers_m;
    for (const Marker& marker : fit_.markers())
      if (marker.body == b) body_markers_m.push_back(marker.at_m);
    if (body_markers_m.size() >= min_markers_of_pose)
      poses[b] = find_body(body_markers_m, points, tolerance_m);
  }
  std::vector<JointReading> joints = predicted_;
  fit_.from_bodies(poses, joints);
  return fit_joints(assign_nearest(fit_.markers(), fit_.poses(joints), points, options_.gate_m),
                    joints);
}

bool Capture::fit_joints(const MarkerPoints& measured, std::vector<JointReading> joints) {
  const auto count =
      std::ranges::count_if(measured, [](const auto& point) { return point.has_value(); });
  if (static_cast<std::size_t>(count) < options_.min_markers) return false;
  const double residual_m = fit_.fit(measured, joints);
  if (!(residual_m < options_.lost_m)) return false;
  captured_ = {std::move(joints),
               {},
               fit_.variance_rad2(),
               bodies(measured),
               static_cast<std::size_t>(count),
               residual_m};
  for (std::size_t j = 0; j < captured_.joints.size(); ++j) {
    const int first = fit_.model().first_of(static_cast<int>(j));
    const int dof = first < 0 ? 0 : sim::coordinates_of(captured_.joints[j].type);
    const double max_variance_rad2 = options_.max_known_sigma_rad * options_.max_known_sigma_rad;
    captured_.known.push_back(dof == 0 || captured_.variance_rad2.segment(first, dof).maxCoeff() <
                                              max_variance_rad2);
  }
  return true;
}

/// v ← v + g (q ⊖ q predicted)/dt for tracked joints; 0 for joints that are unknown now or
/// were unknown before.
void Capture::update_velocities(const std::vector<bool>& known_before, double dt_s) {
  for (std::size_t j = 0; j < captured_.joints.size(); ++j) {
    JointReading& joint = captured_.joints[j];
    joint.velocity_rad_per_s = {};
    if (known_before.empty() || !known_before[j] || !captured_.known[j] || !(dt_s > 0)) continue;
    const auto correction = sim::displacement(joint.type, predicted_[j].position, joint.position);
    for (std::size_t d = 0; d < 3; ++d)
      joint.velocity_rad_per_s[d] =
          predicted_[j].velocity_rad_per_s[d] + options_.velocity_gain * correction[d] / dt_s;
  }
}

std::vector<std::optional<BodyPose>> Capture::bodies(const MarkerPoints& measured) const {
  std::vector<std::optional<BodyPose>> poses(fit_.tree().bodies.size());
  for (std::size_t b = 0; b < poses.size(); ++b) {
    std::vector<Vec3> body_markers_m, measured_m;
    for (std::size_t k = 0; k < measured.size(); ++k)
      if (measured[k] && fit_.markers()[k].body == b)
        body_markers_m.push_back(fit_.markers()[k].at_m), measured_m.push_back(*measured[k]);
    if (body_markers_m.size() >= min_markers_of_pose)
      poses[b] = rigid_pose(body_markers_m, measured_m);
  }
  return poses;
}

}  // namespace capture
