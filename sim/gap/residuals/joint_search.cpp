// Estimates the angles of unmeasured joints, and of joints whose sensor has play, from the tendons.
#include <algorithm>
#include <cmath>

#include "sim/gap/residuals/indices.hpp"
#include "sim/gap/residuals/pose_from_tendons.hpp"
#include "sim/gap/residuals/stages.hpp"

namespace sim::residuals {
namespace {

/// The signals of an episode that the tendons' law needs: shaft angles and tensions.
Episode tendon_signals(const Episode& episode) {
  Episode lines{episode.name, episode.period_s, episode.rows, {}, {}};
  for (const ActuatorSignals& s : episode.actuators)
    lines.actuators.push_back({.shaft_rad = s.shaft_rad, .tension_N = s.tension_N});
  return lines;
}

/// The largest D/κ of the given tendons.
double slowest_damper_s(const erp::Robot& robot, std::span<const std::size_t> lines) {
  double slowest_s = 0;
  for (const std::size_t a : lines) {
    const erp::Tendon& tendon = robot.actuators[a].tendon;
    slowest_s = std::max(slowest_s, tendon.damping_N_s_per_m / Spring::of(tendon).slope_N_per_m(0));
  }
  return slowest_s;
}

}  // namespace

std::vector<std::size_t> Stages::missing_joints(const JointTrace& trace) const {
  const auto& joints = bones_.joint_list();
  std::vector<std::size_t> missing;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (std::ranges::count(recorded_joints_, joints[j].name) &&
        joints[j].type != erp::JointType::free && !was_measured(trace.signals[j], joints[j].type))
      missing.push_back(j);
  return missing;
}

std::vector<std::size_t> Stages::informative_tendons(const Episode& episode,
                                                     const JointTrace& trace,
                                                     std::span<const std::size_t> missing) const {
  const auto& joints = bones_.joint_list();
  std::vector<std::size_t> lines;
  for (std::size_t a = 0; a < episode.actuators.size(); ++a) {
    const ActuatorSignals& s = episode.actuators[a];
    const auto crossed = bones_.crossed_by(a);
    const bool is_determined = std::ranges::all_of(crossed, [&](std::size_t j) {
      return std::ranges::count(missing, j) || was_measured(trace.signals[j], joints[j].type);
    });
    if (is_determined && !equipped_.robot.actuators[a].tendon.path.empty() &&
        !s.shaft_rad.empty() && !s.tension_N.empty())
      lines.push_back(a);
  }
  return lines;
}

std::vector<ChainTrace> Stages::chains_of(const Episode& episode,
                                          std::span<const std::size_t> lines,
                                          const JointTrace& joints) {
  const auto paths = this->paths(episode, joints, lines);
  std::vector<ChainTrace> chains;
  for (std::size_t n = 0; n < lines.size(); ++n)
    chains.push_back(chain(episode, lines[n], paths[n]));
  return chains;
}

void Stages::find_pose(const Episode& episode, JointTrace& trace, const JointTrace* guess) {
  const auto missing = missing_joints(trace), lines = informative_tendons(episode, trace, missing);
  if (missing.empty() || lines.empty()) return;
  const bool has_guess = guess && guess->estimated;
  if (has_guess) trace.nearby = guess->nearby;
  const Episode tendon_episode = tendon_signals(episode);
  const auto chains = [&](const std::vector<JointSignals>& signals) {
    return chains_of(tendon_episode, lines, {.signals = signals, .nearby = trace.nearby});
  };
  const PoseSearch search(bones_.joint_list(), missing, chains, episode.period_s,
                          slowest_damper_s(equipped_.robot, lines));
  if (lines.size() < search.unknowns()) return;
  constexpr int steps_from_start = 6, steps_from_guess = 2;  // chosen
  if (has_guess)
    for (const std::size_t j : missing) trace.signals[j] = guess->signals[j];
  else search.start(trace.signals, episode.rows);
  search.refine(trace.signals, has_guess ? steps_from_guess : steps_from_start,
                has_guess ? steps_from_guess : 1);
  trace.estimated = trace.depends_on_tendons = true;
  if (!trace.nearby) trace.nearby = nearby(episode, trace, missing);
}

void Stages::find_crossings(const Episode& episode, JointTrace& trace,
                            std::span<const LooseJoint> loose) {
  const auto lines = informative_tendons(episode, trace, {});
  if (loose.empty() || lines.empty() || trace.estimated) return;
  std::vector<std::size_t> joints;
  for (const LooseJoint& l : loose) joints.push_back(l.joint);
  const Episode tendon_episode = tendon_signals(episode);
  const auto chains = [&](const std::vector<JointSignals>& signals) {
    return chains_of(tendon_episode, lines, {.signals = signals});
  };
  const PoseSearch search(bones_.joint_list(), joints, chains, episode.period_s,
                          slowest_damper_s(equipped_.robot, lines));
  if (lines.size() < search.unknowns()) return;
  trace.depends_on_tendons = true;
  auto estimated = trace.signals;
  constexpr int steps = 2;  // chosen
  search.refine(estimated, steps, steps);
  for (const LooseJoint& l : loose) {
    const Signal& angle = estimated[l.joint].angle_rad;
    const auto is_crossing = may_cross(l.reading_rad, episode.period_s);
    for (std::size_t k = 0; k < is_crossing.size(); ++k)
      if (is_crossing[k] && !std::isnan(angle[k]))
        trace.signals[l.joint].angle_rad[k] = std::clamp(
            angle[k], l.reading_rad[k] - l.width_rad / 2, l.reading_rad[k] + l.width_rad / 2);
  }
}

std::shared_ptr<const PathsNearby> Stages::nearby(const Episode& episode, const JointTrace& trace,
                                                  std::span<const std::size_t> missing) {
  constexpr double perturbation_rad = 1e-3;
  const auto actuators = each(episode.actuators.size());
  PathsNearby linearized{
      trace.signals, bones_.paths(trace.signals, episode.rows, actuators), {}, {}};
  linearized.slope_m.resize(actuators.size());
  for (const std::size_t j : missing) {
    if (bones_.joint_list()[j].type == erp::JointType::fixed) continue;
    if (bones_.joint_list()[j].type != erp::JointType::revolute) return nullptr;
    auto perturbed = trace.signals;
    for (double& angle : perturbed[j].angle_rad) angle += perturbation_rad;
    auto moved_paths = bones_.paths(perturbed, episode.rows, actuators);
    for (const std::size_t a : actuators) {
      Signal& slope = linearized.slope_m[a].emplace_back(std::move(moved_paths[a].length_m));
      for (std::size_t k = 0; k < slope.size(); ++k)
        slope[k] = (slope[k] - linearized.paths[a].length_m[k]) / perturbation_rad;
    }
    linearized.hinges.push_back(j);
  }
  return std::make_shared<const PathsNearby>(std::move(linearized));
}

}  // namespace sim::residuals
