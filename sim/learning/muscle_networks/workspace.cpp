#include "sim/learning/muscle_networks/workspace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "sim/control/pose_plan.hpp"
#include "sim/model/actuator/motor.hpp"
#include "sim/model/actuator/musculoskeletal.hpp"

namespace sim::muscle_networks {
namespace {

/// Uniform in a ball of radius `max_rad`.
std::array<double, 3> random_rotation(double max_rad, std::mt19937_64& random) {
  std::uniform_real_distribution<double> component(-max_rad, max_rad);
  for (;;)
    if (const std::array rotation{component(random), component(random), component(random)};
        std::hypot(rotation[0], rotation[1], rotation[2]) <= max_rad)
      return rotation;
}

/// Durations of motions that the motors can follow.
class Pace {
 public:
  Pace(const erp::Robot& robot, double share) : model_(robot) {
    for (const erp::Actuator& actuator : robot.actuators)
      max_m_per_s_.push_back(
          share * top_line_speed_m_per_s(robot.motor_of(actuator), actuator.spindle.radius_m));
  }

  /// Computed from the change of each tendon's path, linearised at the middle of the motion.
  double duration_s(const Pose& from, const Pose& to) {
    constexpr double min_s = 0.2, top_over_mean_speed = 1.5;  // chosen
    std::vector<JointReading> middle;
    Eigen::VectorXd u(model_.coordinates());
    const auto& joints = model_.tree().joints;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      auto joint_u = displacement(joints[j].type, from[j], to[j]);
      const int first = model_.skeleton().first_of(static_cast<int>(j));
      for (int d = 0; d < coordinates_of(joints[j].type); ++d) {
        u[first + d] = joint_u[static_cast<std::size_t>(d)];
        joint_u[static_cast<std::size_t>(d)] /= 2;
      }
      middle.push_back(
          {.type = joints[j].type, .position = displaced(joints[j].type, from[j], joint_u)});
    }
    model_.place(middle);
    const Eigen::VectorXd change_m = model_.jacobian() * u;
    double duration_s = min_s;
    for (std::size_t a = 0; a < max_m_per_s_.size(); ++a)
      duration_s = std::max(
          duration_s,
          top_over_mean_speed * std::abs(change_m[static_cast<Eigen::Index>(a)]) / max_m_per_s_[a]);
    return duration_s;
  }

 private:
  Musculoskeletal model_;
  std::vector<double> max_m_per_s_;
};

/// A sequence of poses, each far from those passed before.
class PoseSequence {
 public:
  PoseSequence(const erp::Robot& robot, const JointMotionOptions& options)
      : joints_(robot.joints()),
        options_(options),
        workspace_(robot, options.workspace),
        pace_(robot, options.share),
        poses_{{0, starting_pose(robot)}} {}

  bool done() const { return poses_.back().time_s >= options_.duration_s; }
  const std::vector<TimedPose>& poses() const { return poses_; }

  /// Appends, among random candidates within the joints' range, the pose with the largest distance
  /// from all passed poses per travel time.
  void append_pose() {
    constexpr int candidates = 60;  // chosen
    std::optional<TimedPose> best;
    double best_rad_per_s = 0;
    for (int k = 0; k < candidates; ++k) {
      const Pose pose = workspace_.draw();
      const double duration_s = pace_.duration_s(poses_.back().pose, pose);
      const TimedPose next{poses_.back().time_s + duration_s, pose};
      const double distance_per_time = distance_from_passed_rad(pose) / duration_s;
      if (distance_per_time > best_rad_per_s && in_range(next))
        best = next, best_rad_per_s = distance_per_time;
    }
    constexpr double pause_s = 0.1;  // chosen; after a pause the path to the next pose is straight
    poses_.push_back(best ? *best : TimedPose{poses_.back().time_s + pause_s, poses_.back().pose});
  }

 private:
  double distance_from_passed_rad(const Pose& pose) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const TimedPose& passed : poses_) {
      double square = 0;
      for (std::size_t j = 0; j < joints_.size(); ++j)
        for (const double d : displacement(joints_[j].type, passed.pose[j], pose[j]))
          square += d * d;
      nearest = std::min(nearest, std::sqrt(square));
    }
    return nearest;
  }
  /// Checks only the last poses, because a new pose hardly changes the path before them.
  bool in_range(const TimedPose& next) const {
    constexpr std::size_t checked_poses = 5;  // chosen
    std::vector<TimedPose> end(
        poses_.end() - std::ptrdiff_t(std::min(poses_.size(), checked_poses)), poses_.end());
    end.push_back(next);
    return !leaves_range(JointPath(joints_, end, Via::through), joints_);
  }

  std::vector<erp::Joint> joints_;
  JointMotionOptions options_;
  Workspace workspace_;
  Pace pace_;
  std::vector<TimedPose> poses_;
};

}  // namespace

Workspace::Workspace(const erp::Robot& robot, const WorkspaceOptions& options)
    : robot_(robot),
      options_(options),
      joints_(robot.joints()),
      start_(starting_pose(robot)),
      holder_(robot),
      random_(options.seed) {}

Pose Workspace::draw() {
  constexpr int max_draws = 1000;  // chosen
  for (int attempt = 0; attempt < max_draws; ++attempt)
    if (const Pose pose = random_posture(); is_held(pose)) return pose;
  throw std::runtime_error(
      "the muscles of robot \"" + robot_.name +
      "\" hold none of a thousand random postures; run `erp model balance` to see what is missing");
}

Pose Workspace::random_posture() {
  Pose pose = start_;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const erp::Joint& joint = joints_[j];
    if (joint.type == erp::JointType::revolute) {
      const double middle = (joint.min_rad + joint.max_rad) / 2;
      const double half_range_rad = std::max(0.0, joint.max_rad - middle - options_.margin_rad);
      pose[j][0] =
          std::uniform_real_distribution(middle - half_range_rad, middle + half_range_rad)(random_);
    }
    if (joint.type == erp::JointType::spherical)
      pose[j] = displaced(joint.type, start_[j], random_rotation(options_.ball_rad, random_));
  }
  return pose;
}

bool Workspace::is_held(const Pose& pose) {
  const Holding holding = holder_.hold(pose);
  if (!(holding.unbalanced_Nm <= options_.left_Nm)) return false;
  for (std::size_t a = 0; a < robot_.actuators.size(); ++a)
    if (holding.tension_N[a] > options_.share * robot_.actuators[a].max_tension_N) return false;
  return true;
}

std::vector<std::vector<JointReading>> postures(const erp::Robot& robot, std::size_t count,
                                                const WorkspaceOptions& options) {
  Workspace workspace(robot, options);
  const auto joints = robot.joints();
  std::vector<std::vector<JointReading>> drawn(count);
  for (auto& posture : drawn) {
    const Pose pose = workspace.draw();
    for (std::size_t j = 0; j < joints.size(); ++j)
      posture.push_back({.type = joints[j].type, .position = pose[j]});
  }
  return drawn;
}

recording::Table joint_motion(const erp::Robot& robot, const JointMotionOptions& options) {
  PoseSequence sequence(robot, options);
  while (!sequence.done()) sequence.append_pose();
  return table_of(sequence.poses(), robot);
}

}  // namespace sim::muscle_networks
