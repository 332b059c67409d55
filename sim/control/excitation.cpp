#include "sim/control/excitation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "sim/control/pose_plan.hpp"

namespace sim {
namespace {

using Random = std::mt19937_64;

double between(Random& r, double low, double high) {
  return std::uniform_real_distribution(low, high)(r);
}

/// A random posture: within most of a hinge's range, and near the start for ball joints.
Pose posture(const erp::Robot& robot, double share, Random& random) {
  Pose pose = starting_pose(robot);
  const auto joints = robot.joints();
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const erp::Joint& joint = joints[k];
    if (joint.type == erp::JointType::revolute) {
      const double margin = (1 - share) / 2 * (joint.max_rad - joint.min_rad);
      pose[k][0] = between(random, joint.min_rad + margin, joint.max_rad - margin);
    }
    if (joint.type == erp::JointType::spherical) {
      const Eigen::Vector3d turn =
          0.3 * share *
          Eigen::Vector3d(between(random, -1, 1), between(random, -1, 1), between(random, -1, 1));
      const Eigen::Quaterniond q(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
      pose[k] = {q.w(), q.x(), q.y(), q.z()};
    }
  }
  return pose;
}

/// Moves all hinges to one end of their range or, for odd `turn`, to the other; `scale`: fraction of the
/// range, about its middle.
void go_to_end(const erp::Robot& robot, std::size_t turn, double scale, Pose& pose) {
  const auto joints = robot.joints();
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (joints[k].type != erp::JointType::revolute) continue;
    const double margin = (0.03 + (1 - scale) / 2) * (joints[k].max_rad - joints[k].min_rad);
    pose[k][0] = turn % 2 ? joints[k].max_rad - margin : joints[k].min_rad + margin;
  }
}

/// Mean maximum tension of the muscles, relative to the 150 N for which the walks below are designed.
double relative_strength(const erp::Robot& robot) {
  double sum_N = 0;
  for (const erp::Actuator& actuator : robot.actuators) sum_N += actuator.max_tension_N;
  return sum_N / static_cast<double>(robot.actuators.size()) / 150;
}

struct Walk {
  double share, pace_s, dwell_s, rest_N, least_N;
  bool to_the_ends = false;
  double scale = 1;  ///< of the range of postures
};

/// Throws std::invalid_argument if a tendon has no path in one of the postures.
Excitation through_postures(const erp::Robot& robot, const Walk& walk, double duration_s,
                            Random& random) {
  std::vector<TimedPose> poses{{0, starting_pose(robot)}};
  for (double t = 0.4; t < duration_s + walk.pace_s;) {
    poses.push_back({t, poses.back().pose});
    t += walk.pace_s * between(random, 0.7, 1.3);
    poses.push_back({t, posture(robot, walk.scale * walk.share, random)});
    if (walk.to_the_ends) go_to_end(robot, poses.size() / 2, walk.scale, poses.back().pose);
    t += walk.dwell_s * between(random, 0.5, 1.5);
  }
  const double strong = relative_strength(robot);
  const auto plan =
      lengths_through(robot, poses, {{strong * walk.rest_N, strong * walk.least_N}, 0.02});
  const auto& columns = plan.table.columns;
  const auto& time = columns.at(0).values;
  Excitation all;
  std::size_t at = 0;
  for (double t = 0; t < duration_s; t += all.period_s) {
    while (at + 2 < time.size() && time[at + 1] <= t) ++at;
    const double s = std::clamp((t - time[at]) / (time[at + 1] - time[at]), 0.0, 1.0);
    const double in = std::min(1.0, t / 0.4);  // blends from the starting pose to the first posture
    auto& row = all.reference.emplace_back();
    for (const erp::Actuator& actuator : robot.actuators)
      for (const auto& column : columns)
        if (column.name == actuator.name + ".reference")
          row.push_back(in * ((1 - s) * column.values[at] + s * column.values[at + 1]));
  }
  return all;
}

/// Reduces the range of the postures until every tendon has a path.
Excitation within_reach(const erp::Robot& robot, Walk walk, double duration_s,
                        const Random& random) {
  constexpr double narrower = 0.7, least = 0.2;  // chosen
  for (;; walk.scale *= narrower) try {
      Random drawn = random;
      return through_postures(robot, walk, duration_s, drawn);
    } catch (const std::invalid_argument&) {
      if (walk.scale < least) throw;
    }
}

/// In addition each muscle in turn pulls alone, slowly and then faster, against the muscles that hold the
/// posture. This separates the effects of one muscle from those of the others.
void pull_in_turn(const erp::Robot& robot, Excitation& all) {
  constexpr double share = 0.15;   // of its maximum tension
  constexpr int pulls[] = {1, 3};  // half waves in each half of a muscle's interval
  const std::size_t turn = all.reference.size() / robot.actuators.size();
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const erp::Actuator& actuator = robot.actuators[a];
    const double most_m = share * actuator.max_tension_N / actuator.tendon.stiffness_N_per_m;
    for (std::size_t k = 0; k < turn; ++k) {
      const double half = 2 * double(k) / double(turn), within = half < 1 ? half : half - 1;
      const double wave = std::sin(std::numbers::pi * pulls[half >= 1] * within);
      all.reference[a * turn + k][a] -= most_m * wave * wave;
    }
  }
}

struct Swing {
  double middle_N, swing_N, swing_Hz, ripple_N, ripple_Hz, least_N;
};

/// Oscillating tensions, with opposite phase for antagonists.
Excitation tensions(const erp::Robot& robot, const Swing& swing, double duration_s,
                    Random& random) {
  Excitation all{erp::Mode::force, 0.002, {}};
  const double turn = 2 * std::numbers::pi, phase = between(random, 0, turn);
  const double slow_Hz = swing.swing_Hz * between(random, 0.8, 1.25);
  const double fast_Hz = swing.ripple_Hz * between(random, 0.8, 1.25);
  for (double t = 0; t < duration_s; t += all.period_s) {
    auto& row = all.reference.emplace_back();
    for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
      const double sign = a % 2 ? -1 : 1;
      const double tension_N = swing.middle_N +
                               sign * swing.swing_N * std::sin(turn * slow_Hz * t + phase) +
                               sign * swing.ripple_N * std::sin(turn * fast_Hz * t) +
                               0.3 * swing.middle_N * std::sin(turn * 0.13 * t + 1);
      row.push_back(std::clamp(tension_N, swing.least_N, 0.8 * robot.actuators[a].max_tension_N));
    }
  }
  return all;
}

}  // namespace

const char* excitation_name(const erp::Robot& robot, int recording) {
  constexpr const char* postures[] = {"end to end", "each muscle in turn", "fast postures",
                                      "each muscle in turn, stiff"};
  if (robot.joints().size() != 1 || recording % 2 == 0) return postures[recording % 4];
  return recording % 4 == 1 ? "gentle tensions" : "strong tensions";
}

Excitation excitation(const erp::Robot& robot, int recording, double duration_s,
                      std::uint64_t seed) {
  Random random(seed * 977 + static_cast<std::uint64_t>(recording));
  const Walk slow{0.98, 1.6, 0.5, 10, 4, true}, low{0.7, 1.0, 0.3, 5, 2},
      high{0.8, 0.8, 0.2, 25, 8}, fast{0.6, 0.35, 0.1, 15, 5};
  if (robot.joints().size() == 1 && recording % 2 == 1) {
    const bool gentle = recording % 4 == 1;
    const Swing swing = gentle ? Swing{8, 12, 0.35, 3, 1.6, 0.0} : Swing{22, 18, 0.5, 6, 2.3, 1.0};
    return tensions(robot, swing, duration_s, random);
  }
  const Walk walks[] = {slow, low, fast, high};
  Excitation all = within_reach(robot, walks[recording % 4], duration_s, random);
  if (recording % 2 == 1) pull_in_turn(robot, all);
  return all;
}

}  // namespace sim
