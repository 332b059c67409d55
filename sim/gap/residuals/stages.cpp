#include "sim/gap/residuals/stages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/gap/residuals/chain_residuals.hpp"
#include "sim/gap/residuals/indices.hpp"
#include "sim/model/actuator/sensors.hpp"

namespace sim::residuals {
namespace {

using Eigen::MatrixXd;

template <class T>
std::shared_ptr<const T> shared(T value) {
  return std::make_shared<const T>(std::move(value));
}

/// Step of the encoder; 0: not specified.
double shaft_step_rad(const erp::Robot& robot, const erp::Actuator& actuator) {
  const erp::SensorType& sensors = robot.sensors_of(actuator);
  if (!(sensors.encoder_counts_per_rev > 0)) return 0;
  return SensorScale(robot.motor_of(actuator), sensors).shaft_rad_per_count;
}

/// The joints without linearized paths, for a robot whose tendon paths have changed.
std::shared_ptr<const JointTrace> without_nearby(const JointTrace& joints) {
  JointTrace copy = joints;
  copy.nearby = nullptr;
  return shared(std::move(copy));
}

}  // namespace

Stages::Stages(const erp::Robot& robot, const Windows& windows)
    : equipped_(effects::equip(robot)), windows_(windows), bones_(equipped_.robot) {
  for (const erp::Joint& joint : robot.joints()) recorded_joints_.push_back(joint.name);
}

Reach Stages::reach(const effects::Placed& placed) const {
  const effects::About& about = effects::about(placed.effect);
  const bool is_sensor = about.stage == effects::Stage::sensor || about.type == "joint_play";
  if (about.type == "skeleton_link_flexibility") return {.joints = true, .bones = true};
  if (about.stage == effects::Stage::bus) return {};
  if (about.seat != effects::Seat::actuator)
    return {.joints = about.seat == effects::Seat::joint && is_sensor, .bones = true};
  const auto& actuators = equipped_.robot.actuators;
  const auto actuator = static_cast<std::size_t>(
      std::ranges::find(actuators, placed.on, &erp::Actuator::name) - actuators.begin());
  Reach reach{.line = about.stage != effects::Stage::motor, .chain = actuator};
  if (about.stage == effects::Stage::routing) reach.path = actuator;
  return reach;
}

std::vector<std::size_t> windows_of(const Episode& episode, const Windows& windows) {
  const std::size_t reach = 2 * Bump(windows.half_width_s, episode.period_s).reach() + 1;
  const auto stride =
      static_cast<std::size_t>(std::max<long>(1, std::lround(windows.stride_s / episode.period_s)));
  std::vector<std::size_t> rows;
  for (std::size_t k = reach; k + reach < episode.rows; k += stride)
    if (episode.judged(k)) rows.push_back(k);
  return rows;
}

Explanation Stages::explain(const Episode& episode) { return explain(episode, nullptr); }

Explanation Stages::explain(const Episode& episode, std::shared_ptr<const JointTrace> guess) {
  const std::size_t count = equipped_.robot.actuators.size();
  Explanation explanation;
  explanation.joints = std::move(guess);
  explanation.rows = windows_of(episode, windows_);
  explanation.paths.resize(count), explanation.gradients.resize(count);
  explanation.chains.resize(count), explanation.chain_residuals.resize(count);
  return recompute(episode, std::move(explanation), {true, true, each(count), each(count)});
}

Explanation Stages::explain(const Episode& episode, const Explanation& base, const Reach& reach) {
  const JointTrace& joints = *base.joints;
  if (reach.line && joints.estimated)
    return explain(episode, reach.path ? without_nearby(joints) : base.joints);
  if (reach.joints || (reach.line && joints.depends_on_tendons) ||
      (reach.bones && joints.depends_on_bodies))
    return explain(episode);
  Touched touched{false, reach.bones, {}, {}};
  if (reach.path) touched.paths = {*reach.path};
  if (reach.chain) touched.chains = {*reach.chain};
  return recompute(episode, base, touched);
}

ChainTrace Stages::chain(const Episode& episode, std::size_t a, const PathTrace& path,
                         const ChainTrace* other) const {
  const erp::Actuator& actuator = equipped_.robot.actuators[a];
  return trace({equipped_.robot.motor_of(actuator), actuator,
                effects::Acting(equipped_.acting, actuator.name, effects::Seat::actuator),
                bones_.initial_length_m(a), shaft_step_rad(equipped_.robot, actuator)},
               episode.actuators[a], path, episode.period_s, windows_.speed_half_width_s, other);
}

std::vector<PathTrace> Stages::paths(const Episode& episode, const JointTrace& joints,
                                     std::span<const std::size_t> actuators) {
  std::vector<PathTrace> paths = joints.nearby
                                     ? paths_nearby(joints, actuators)
                                     : bones_.paths(joints.signals, episode.rows, actuators);
  for (PathTrace& path : paths) path.smooth(episode.period_s, windows_.speed_half_width_s);
  return paths;
}

std::vector<PathTrace> Stages::paths_nearby(const JointTrace& joints,
                                            std::span<const std::size_t> actuators) const {
  const PathsNearby& linearized = *joints.nearby;
  std::vector<PathTrace> paths;
  for (const std::size_t a : actuators) {
    PathTrace& path = paths.emplace_back(linearized.paths[a]);
    for (std::size_t h = 0; h < linearized.hinges.size() && !path.length_m.empty(); ++h) {
      const Signal& angle = joints.signals[linearized.hinges[h]].angle_rad;
      const Signal& linearized_at = linearized.pose[linearized.hinges[h]].angle_rad;
      for (std::size_t k = 0; k < path.length_m.size(); ++k)
        path.length_m[k] += linearized.slope_m[a][h][k] * (angle[k] - linearized_at[k]);
    }
  }
  return paths;
}

Explanation Stages::recompute(const Episode& episode, Explanation e, const Touched& touched) {
  if (touched.joints) e.joints = shared(joint_trace(episode, e.rows, e.joints.get()));
  auto paths = this->paths(episode, *e.joints, touched.paths);
  auto gradients = bones_.gradients(e.joints->motions, touched.paths);
  for (std::size_t n = 0; n < touched.paths.size(); ++n) {
    e.paths[touched.paths[n]] = shared(std::move(paths[n]));
    e.gradients[touched.paths[n]] = shared(std::move(gradients[n]));
  }
  const erp::Robot& robot = equipped_.robot;
  for (const std::size_t a : touched.chains) {
    const erp::Actuator& actuator = robot.actuators[a];
    e.chains[a] = shared(chain(episode, a, *e.paths[a], e.chains[a].get()));
    const Bump bump(windows_.half_width_s, episode.period_s);
    e.chain_residuals[a] = shared(
        chain_residuals(*e.chains[a], actuator, robot.motor_of(actuator), episode, bump, e.rows));
  }
  if (touched.bones) e.bones = shared(bones(episode, *e.joints, e.rows));
  e.residuals.clear();
  for (const auto& residuals : e.chain_residuals)
    e.residuals.insert(e.residuals.end(), residuals->begin(), residuals->end());
  add_joints(episode, e);
  return e;
}

}  // namespace sim::residuals
