#include "components/motion_capture/capture.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/skeleton/joint_path.hpp"

namespace capture {

using sim::BodyPose;
using sim::JointReading;
using sim::Vec3;

Capture::Capture(const sim::RobotTree& tree, std::vector<Marker> markers,
                 std::array<sim::cameras::Camera, 2> cameras, const CaptureOptions& options)
    : cameras_(std::move(cameras)), options_(options), fit_(tree, std::move(markers), options.fit) {
  for (const erp::Joint& joint : tree.joints) joints_.push_back(sim::initial_reading(joint));
}

std::optional<Captured> Capture::see(const sim::cameras::Image& left,
                                     const sim::cameras::Image& right, double dt_s) {
  const auto points = triangulate(cameras_[0], find_spots(left, options_.spots), cameras_[1],
                                  find_spots(right, options_.spots), options_.stereo);
  predict(dt_s);
  const std::vector<bool> known_before = lost_ ? std::vector<bool>{} : captured_.known;
  const bool followed = !lost_ && track(points);
  const bool whole = followed && all_known();
  const bool found = whole || search(points) || followed;
  if (found) update_velocities(known_before, dt_s);
  lost_ = !found;
  if (!found) return std::nullopt;
  joints_ = captured_.joints;
  return captured_;
}

/// Predicts the joints with constant velocity.
void Capture::predict(double dt_s) {
  predicted_ = joints_;
  for (JointReading& joint : predicted_) {
    std::array<double, 3> way = joint.velocity_rad_per_s;
    for (double& turn : way) turn *= dt_s;
    joint.position = sim::displaced(joint.type, joint.position, way);
  }
}

bool Capture::track(std::span<const StereoPoint> points) {
  return fit_joints(follow(fit_.markers(), fit_.poses(predicted_), points, options_.gate_m),
                    predicted_);
}

bool Capture::all_known() const {
  return std::ranges::all_of(captured_.known, [](bool one) { return one; });
}

/// Finds each body by the distances between its markers.
bool Capture::search(std::span<const StereoPoint> points) {
  constexpr double within_m = 0.004;  // chosen
  std::vector<std::optional<BodyPose>> found(fit_.tree().bodies.size());
  for (std::size_t b = 0; b < found.size(); ++b) {
    std::vector<Vec3> own;
    for (const Marker& marker : fit_.markers())
      if (marker.body == b) own.push_back(marker.at_m);
    if (own.size() >= 3) found[b] = find_body(own, points, within_m);
  }
  std::vector<JointReading> joints = predicted_;
  fit_.from_bodies(found, joints);
  return fit_joints(follow(fit_.markers(), fit_.poses(joints), points, options_.gate_m), joints);
}

bool Capture::fit_joints(const MarkerPoints& seen, std::vector<JointReading> joints) {
  const auto count = std::ranges::count_if(seen, [](const auto& one) { return one.has_value(); });
  if (static_cast<std::size_t>(count) < options_.min_markers) return false;
  const double residual_m = fit_.fit(seen, joints);
  if (!(residual_m < options_.lost_m)) return false;
  captured_ = {
      std::move(joints), {}, fit_.variance_rad2(), bodies(seen), static_cast<std::size_t>(count),
      residual_m};
  for (std::size_t j = 0; j < captured_.joints.size(); ++j) {
    const int first = fit_.model().first_of(static_cast<int>(j));
    const int turns = first < 0 ? 0 : sim::coordinates_of(captured_.joints[j].type);
    const double most = options_.known_rad * options_.known_rad;
    captured_.known.push_back(turns == 0 ||
                              captured_.variance_rad2.segment(first, turns).maxCoeff() < most);
  }
  return true;
}

/// v ← v + g (q ⊖ q predicted)/dt for tracked joints; 0 for joints that were just found or are
/// unknown.
void Capture::update_velocities(const std::vector<bool>& known_before, double dt_s) {
  for (std::size_t j = 0; j < captured_.joints.size(); ++j) {
    JointReading& joint = captured_.joints[j];
    joint.velocity_rad_per_s = {};
    if (known_before.empty() || !known_before[j] || !captured_.known[j] || !(dt_s > 0)) continue;
    const auto off = sim::displacement(joint.type, predicted_[j].position, joint.position);
    for (std::size_t d = 0; d < 3; ++d)
      joint.velocity_rad_per_s[d] =
          predicted_[j].velocity_rad_per_s[d] + options_.follow * off[d] / dt_s;
  }
}

std::vector<std::optional<BodyPose>> Capture::bodies(const MarkerPoints& seen) const {
  std::vector<std::optional<BodyPose>> poses(fit_.tree().bodies.size());
  for (std::size_t b = 0; b < poses.size(); ++b) {
    std::vector<Vec3> own, at;
    for (std::size_t k = 0; k < seen.size(); ++k)
      if (seen[k] && fit_.markers()[k].body == b)
        own.push_back(fit_.markers()[k].at_m), at.push_back(*seen[k]);
    if (own.size() >= 3) poses[b] = rigid_pose(own, at);
  }
  return poses;
}

}  // namespace capture
