#include "sim/learning/calibration/pose_set.hpp"

#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "sim/model/actuator/recorded_joints.hpp"

namespace sim::calibration {
namespace {

using Joints = std::vector<JointReading>;

double angle_between_rad(erp::JointType type, const std::array<double, 4>& a,
                         const std::array<double, 4>& b) {
  const auto u = displacement(type, a, b);
  return std::hypot(u[0], u[1], u[2]);
}

double largest_angle_rad(const Joints& a, const Pose& b) {
  double largest_rad = 0;
  for (std::size_t j = 0; j < a.size(); ++j)
    largest_rad = std::max(largest_rad, angle_between_rad(a[j].type, a[j].position, b[j]));
  return largest_rad;
}

/// The rows of one interval at rest, summed relative to its first row.
class StillInterval {
 public:
  StillInterval(double time_s, const Joints& joints, std::size_t actuators)
      : begin_s_(time_s), first_(joints), sum_(joints.size()), shaft_(actuators) {}

  bool contains(const Joints& joints, double turns_rad) const {
    for (std::size_t j = 0; j < joints.size(); ++j)
      if (angle_between_rad(joints[j].type, first_[j].position, joints[j].position) > turns_rad)
        return false;
    return true;
  }
  void add(double time_s, const Joints& joints, const std::vector<double>& shaft_rad) {
    end_s_ = time_s, ++rows_;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const auto u = displacement(joints[j].type, first_[j].position, joints[j].position);
      for (std::size_t d = 0; d < 3; ++d) sum_[j][d] += u[d];
    }
    for (std::size_t a = 0; a < shaft_.size(); ++a) shaft_[a] += shaft_rad[a];
  }
  double duration_s() const { return end_s_ - begin_s_; }
  StillPose mean() const {
    StillPose still{begin_s_, shaft_, {}};
    for (double& angle : still.shaft_rad) angle /= rows_;
    for (std::size_t j = 0; j < first_.size(); ++j) {
      auto u = sum_[j];
      for (double& component : u) component /= rows_;
      still.pose.push_back(displaced(first_[j].type, first_[j].position, u));
    }
    return still;
  }

 private:
  double begin_s_, end_s_ = begin_s_, rows_ = 0;
  Joints first_;
  std::vector<std::array<double, 3>> sum_;
  std::vector<double> shaft_;
};

}  // namespace

std::vector<StillPose> still_poses(const recording::Table& table, const erp::Robot& robot,
                                   const StillOptions& options) {
  const RecordedJoints recorded(robot, table);
  std::vector<const recording::Column*> shafts;
  for (const erp::Actuator& actuator : robot.actuators)
    shafts.push_back(&column_of(table, actuator.name + ".shaft_rad"));
  const auto& time_s = column_of(table, "time_s").values;

  std::vector<StillPose> poses;
  std::optional<StillInterval> interval;
  Joints joints;
  std::vector<double> shaft_rad(shafts.size());
  const auto end = [&] {
    if (!interval || interval->duration_s() < options.still_s) return;
    const StillPose still = interval->mean();
    Joints mean_joints = joints;
    for (std::size_t j = 0; j < mean_joints.size(); ++j) mean_joints[j].position = still.pose[j];
    if (poses.empty() || largest_angle_rad(mean_joints, poses.back().pose) > options.apart_rad)
      poses.push_back(still);
  };
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t a = 0; a < shafts.size(); ++a) shaft_rad[a] = shafts[a]->values[row];
    const bool is_complete = !std::isnan(std::accumulate(shaft_rad.begin(), shaft_rad.end(), 0.0));
    if (!recorded.read(row, joints) || !is_complete) continue;
    if (!interval || !interval->contains(joints, options.turns_rad)) {
      end();
      interval.emplace(time_s[row], joints, shafts.size());
    }
    interval->add(time_s[row], joints, shaft_rad);
  }
  end();
  if (poses.empty())
    throw std::invalid_argument("the robot of this recording is never at rest for " +
                                std::to_string(options.still_s) + " s; hold each pose longer");
  return poses;
}

PoseSet split(std::vector<StillPose> poses) {
  PoseSet set;
  for (std::size_t k = 0; k < poses.size(); ++k)
    (k % 2 ? set.check : set.learn).push_back(std::move(poses[k]));
  return set;
}

PoseErrors errors_between(const erp::Robot& robot, std::span<const StillPose> poses,
                          std::span<const Pose> candidate_poses) {
  PoseErrors errors;
  const auto joints = robot.joints();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (coordinates_of(joints[j].type) == 0) continue;
    double sum_rad = 0;
    for (std::size_t k = 0; k < poses.size(); ++k)
      sum_rad += angle_between_rad(joints[j].type, candidate_poses[k][j], poses[k].pose[j]);
    errors.mean_rad.push_back(sum_rad / static_cast<double>(poses.size()));
    errors.mean_of_all_rad += errors.mean_rad.back();
  }
  errors.mean_of_all_rad /= static_cast<double>(errors.mean_rad.size());
  return errors;
}

PoseErrors pose_errors(const Candidate& candidate, std::span<const StillPose> poses) {
  Equilibrium equilibrium(candidate.robot, candidate.length_offset_m);
  std::vector<Pose> equilibria;
  for (const StillPose& still : poses)
    equilibria.push_back(equilibrium.find(still.shaft_rad, still.pose).pose);
  return errors_between(candidate.robot, poses, equilibria);
}

}  // namespace sim::calibration
