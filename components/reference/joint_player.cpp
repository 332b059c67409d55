#include "components/reference/joint_player.hpp"

#include <algorithm>
#include <cmath>

#include "interfaces/recording/table.hpp"

namespace reference {
namespace {

constexpr double least_start_s = 0.2;  // chosen: even where it is there already

std::vector<sim::TimedPose> poses_of(const JointPlayer::Params& params, const erp::Robot& robot) {
  const auto folder = std::filesystem::path(params.place.file).parent_path();
  auto poses = sim::poses_of(recording::read_table((folder / params.file).string()), robot);
  if (params.loop && poses.size() > 1) {
    const double way_s = poses[1].time_s - poses[0].time_s;
    poses.push_back({poses.back().time_s + way_s, poses.front().pose});
  }
  return poses;
}

sim::Pose pose_of(std::span<const sim::JointReading> readings) {
  sim::Pose pose;
  for (const auto& reading : readings) pose.push_back(reading.position);
  return pose;
}

}  // namespace

JointPlayer::JointPlayer(const Params& params, const erp::Robot& robot)
    : params_(params),
      names_(robot),
      path_(names_.list(), poses_of(params, robot)),
      path_s_(path_.begin_s()) {}

std::optional<erp::JointTarget> JointPlayer::step(const erp::SensorFrame&, double dt_s,
                                                  const node::Latest<erp::JointState>& state) {
  if (!state || !names_.read(state.message, now_)) return std::nullopt;
  if (starting_) start_s_ += dt_s;
  else if (begun_) path_s_ += dt_s;
  lead();
  if (!begun_ || joints::apart_rad(now_, led_) > params_.lost_rad) pick_up();
  erp::JointTarget target;
  names_.write(led_, target);
  return target;
}

/// Where the joints shall be now.
void JointPlayer::lead() {
  if (params_.loop && path_s_ > path_.end_s()) path_s_ -= path_.end_s() - path_.begin_s();
  starting_ = starting_ && start_s_ < start_.end_s();
  if (starting_) start_.at(start_s_, led_);
  else path_.at(path_s_, led_);
}

/// A way from where the robot is to where the path stands.
void JointPlayer::pick_up() {
  path_.at(path_s_, led_);
  const double way_s =
      sim::least_jerk_top_speed * joints::apart_rad(now_, led_) / params_.start_rad_per_s;
  sim::Pose there;
  for (const auto& motion : led_) there.push_back(motion.now.position);
  start_ =
      sim::JointPath(names_.list(), {{0, pose_of(now_)}, {std::max(way_s, least_start_s), there}});
  start_s_ = 0;
  starting_ = begun_ = true;
  lead();
}

}  // namespace reference
