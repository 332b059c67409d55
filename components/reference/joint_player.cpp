#include "components/reference/joint_player.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "interfaces/recording/table.hpp"

namespace reference {
namespace {

constexpr double max_frame_gap_s = 0.05;  // chosen: a longer gap means missing frames

std::vector<sim::TimedPose> poses_of(const JointPlayer::Params& params, const erp::Robot& robot) {
  const auto folder = std::filesystem::path(params.place.file).parent_path();
  auto poses = sim::poses_of(recording::read_table((folder / params.file).string()), robot);
  if (params.loop && poses.size() > 1) {
    const double return_s = poses[1].time_s - poses[0].time_s;
    poses.push_back({poses.back().time_s + return_s, poses.front().pose});
  }
  return poses;
}

void check_range(const sim::JointPath& path, std::span<const erp::Joint> joints) {
  const auto violation = sim::leaves_range(path, joints);
  if (!violation) return;
  const erp::Joint& joint = joints[violation->joint];
  throw std::invalid_argument(
      fmt::format("at {:.2f} s the path moves joint \"{}\" to {:.3f} rad, outside {} … {}; stop in "
                  "the poses (via=\"rest\"), or keep them farther from its stops",
                  violation->time_s, joint.name, violation->at_rad, joint.min_rad, joint.max_rad));
}

}  // namespace

JointPlayer::JointPlayer(const Params& params, const erp::Robot& robot)
    : params_(params),
      names_(robot),
      path_(names_.list(), poses_of(params, robot), params.via),
      path_s_(path_.begin_s()) {
  check_range(path_, names_.list());
}

std::optional<erp::JointTarget> JointPlayer::step(const erp::SensorFrame& frame, double dt_s,
                                                  const node::Latest<erp::JointState>& state) {
  if (!state || !names_.read(state.message, frame.stamp_ns, measured_)) return std::nullopt;
  const bool missed = dt_s > max_frame_gap_s;
  catching_up_s_ += dt_s;
  on_path_ = on_path_ || (has_begun_ && catching_up_s_ >= catch_up_.duration_s());
  if (on_path_ && !missed) path_s_ += dt_s;
  update_reference();
  if (!has_begun_ || missed ||
      joints::largest_rotation_rad(measured_, reference_) > params_.lost_rad)
    begin_catch_up();
  erp::JointTarget target;
  names_.write(reference_, target);
  return target;
}

/// Computes the current reference.
void JointPlayer::update_reference() {
  if (params_.loop && path_s_ > path_.end_s()) path_s_ -= path_.end_s() - path_.begin_s();
  path_.at(path_s_, reference_);
  catch_up_.add(catching_up_s_, reference_);
}

/// Starts a transition from the robot's current position and velocity to the path.
void JointPlayer::begin_catch_up() {
  path_.at(path_s_, reference_);
  catch_up_ = joints::catch_up(measured_, reference_, params_.start_rad_per_s);
  catching_up_s_ = 0;
  has_begun_ = true;
  update_reference();
}

}  // namespace reference
