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

// All values of this file are chosen: the motions make the effects of robots of this size visible.
constexpr double max_ball_rad = 0.3;      // entries of the rotation vector of a ball joint
constexpr double stop_margin = 0.03;      // distance from the stops, of the range
constexpr double first_move_s = 0.4;      // start of the first motion
constexpr double design_tension_N = 150;  // maximum tension of a muscle

double between(Random& r, double low, double high) {
  return std::uniform_real_distribution(low, high)(r);
}

/// A random posture: within most of a hinge's range, and near the start for ball joints.
Pose posture(const erp::Robot& robot, double range_fraction, Random& random) {
  Pose pose = starting_pose(robot);
  const auto joints = robot.joints();
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const erp::Joint& joint = joints[k];
    if (joint.type == erp::JointType::revolute) {
      const double margin = (1 - range_fraction) / 2 * (joint.max_rad - joint.min_rad);
      pose[k][0] = between(random, joint.min_rad + margin, joint.max_rad - margin);
    }
    if (joint.type == erp::JointType::spherical) {
      const Eigen::Vector3d rotation =
          max_ball_rad * range_fraction *
          Eigen::Vector3d(between(random, -1, 1), between(random, -1, 1), between(random, -1, 1));
      const Eigen::Quaterniond q(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()));
      pose[k] = {q.w(), q.x(), q.y(), q.z()};
    }
  }
  return pose;
}

/// Moves all hinges to one end of their range or, for odd `index`, to the other; `scale`: fraction
/// of the range, about its middle.
void set_to_range_end(const erp::Robot& robot, std::size_t index, double scale, Pose& pose) {
  const auto joints = robot.joints();
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (joints[k].type != erp::JointType::revolute) continue;
    const double margin = (stop_margin + (1 - scale) / 2) * (joints[k].max_rad - joints[k].min_rad);
    pose[k][0] = index % 2 ? joints[k].max_rad - margin : joints[k].min_rad + margin;
  }
}

/// Mean maximum tension of the muscles, relative to the tension for which the sequences below are
/// designed.
double relative_strength(const erp::Robot& robot) {
  double sum_N = 0;
  for (const erp::Actuator& actuator : robot.actuators) sum_N += actuator.max_tension_N;
  return sum_N / static_cast<double>(robot.actuators.size()) / design_tension_N;
}

/// Motion from posture to posture.
struct PostureSequence {
  double range_fraction, pace_s, dwell_s, rest_N, least_N;
  bool to_the_ends = false;
  double scale = 1;  ///< of the range of postures
};

/// Throws std::invalid_argument if a tendon has no path in one of the postures.
Excitation through_postures(const erp::Robot& robot, const PostureSequence& sequence,
                            double duration_s, Random& random) {
  std::vector<TimedPose> poses{{0, starting_pose(robot)}};
  for (double t = first_move_s; t < duration_s + sequence.pace_s;) {
    poses.push_back({t, poses.back().pose});
    t += sequence.pace_s * between(random, 0.7, 1.3);
    poses.push_back({t, posture(robot, sequence.scale * sequence.range_fraction, random)});
    if (sequence.to_the_ends)
      set_to_range_end(robot, poses.size() / 2, sequence.scale, poses.back().pose);
    t += sequence.dwell_s * between(random, 0.5, 1.5);
  }
  const double strength = relative_strength(robot);
  const auto plan = lengths_through(
      robot, poses, {{strength * sequence.rest_N, strength * sequence.least_N}, 0.02});
  const auto& columns = plan.table.columns;
  const auto& time = columns.at(0).values;
  Excitation all;
  std::size_t row_index = 0;
  for (double t = 0; t < duration_s; t += all.period_s) {
    while (row_index + 2 < time.size() && time[row_index + 1] <= t) ++row_index;
    const double s =
        std::clamp((t - time[row_index]) / (time[row_index + 1] - time[row_index]), 0.0, 1.0);
    const double blend =
        std::min(1.0, t / first_move_s);  // blends from the starting pose to the first posture
    auto& row = all.reference.emplace_back();
    for (const erp::Actuator& actuator : robot.actuators)
      for (const auto& column : columns)
        if (column.name == actuator.name + ".reference")
          row.push_back(blend *
                        ((1 - s) * column.values[row_index] + s * column.values[row_index + 1]));
  }
  return all;
}

/// Reduces the range of the postures until every tendon has a path.
Excitation with_valid_paths(const erp::Robot& robot, PostureSequence sequence, double duration_s,
                            const Random& random) {
  constexpr double reduction = 0.7, min_scale = 0.2;  // chosen
  for (;; sequence.scale *= reduction) try {
      Random attempt_random = random;
      return through_postures(robot, sequence, duration_s, attempt_random);
    } catch (const std::invalid_argument&) {
      if (sequence.scale < min_scale) throw;
    }
}

/// In addition each muscle in turn pulls alone, slowly and then faster, against the muscles that
/// hold the posture. This separates the effects of one muscle from those of the others.
void pull_in_turn(const erp::Robot& robot, Excitation& all) {
  constexpr double tension_fraction = 0.15;  // of its maximum tension
  constexpr int pulls[] = {1, 3};            // half waves in each half of a muscle's interval
  const std::size_t rows_per_muscle = all.reference.size() / robot.actuators.size();
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const erp::Actuator& actuator = robot.actuators[a];
    const double amplitude_m =
        tension_fraction * actuator.max_tension_N / actuator.tendon.stiffness_N_per_m;
    for (std::size_t k = 0; k < rows_per_muscle; ++k) {
      const double half = 2 * double(k) / double(rows_per_muscle),
                   position_in_half = half < 1 ? half : half - 1;
      const double wave = std::sin(std::numbers::pi * pulls[half >= 1] * position_in_half);
      all.reference[a * rows_per_muscle + k][a] -= amplitude_m * wave * wave;
    }
  }
}

/// Tension of a muscle: mean, slow oscillation, fast oscillation, lower bound.
struct TensionOscillation {
  double middle_N, swing_N, swing_Hz, ripple_N, ripple_Hz, least_N;
};

/// Oscillating tensions, with opposite phase for antagonists.
Excitation tensions(const erp::Robot& robot, const TensionOscillation& swing, double duration_s,
                    Random& random) {
  Excitation all{erp::Mode::force, 0.002, {}};
  const double turn_rad = 2 * std::numbers::pi, phase = between(random, 0, turn_rad);
  const double slow_Hz = swing.swing_Hz * between(random, 0.8, 1.25);
  const double fast_Hz = swing.ripple_Hz * between(random, 0.8, 1.25);
  for (double t = 0; t < duration_s; t += all.period_s) {
    auto& row = all.reference.emplace_back();
    for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
      const double sign = a % 2 ? -1 : 1;
      const double tension_N = swing.middle_N +
                               sign * swing.swing_N * std::sin(turn_rad * slow_Hz * t + phase) +
                               sign * swing.ripple_N * std::sin(turn_rad * fast_Hz * t) +
                               0.3 * swing.middle_N * std::sin(turn_rad * 0.13 * t + 1);
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
  const PostureSequence slow{0.98, 1.6, 0.5, 10, 4, true}, low{0.7, 1.0, 0.3, 5, 2},
      high{0.8, 0.8, 0.2, 25, 8}, fast{0.6, 0.35, 0.1, 15, 5};
  if (robot.joints().size() == 1 && recording % 2 == 1) {
    const bool gentle = recording % 4 == 1;
    const TensionOscillation swing = gentle ? TensionOscillation{8, 12, 0.35, 3, 1.6, 0.0}
                                            : TensionOscillation{22, 18, 0.5, 6, 2.3, 1.0};
    return tensions(robot, swing, duration_s, random);
  }
  const PostureSequence sequences[] = {slow, low, fast, high};
  Excitation all = with_valid_paths(robot, sequences[recording % 4], duration_s, random);
  if (recording % 2 == 1) pull_in_turn(robot, all);
  return all;
}

}  // namespace sim
