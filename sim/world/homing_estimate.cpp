#include "sim/world/homing_estimate.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/world/simulated_robot.hpp"

namespace sim {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double sigma_line_m = 0.0003, sigma_sensor_rad = 0.002, sigma_start_rad = 0.5;
constexpr double min_taut_N = 1;  // chosen: slack tendons do not measure the pose
constexpr int max_steps = 60;     // chosen
constexpr double tick_s = 0.002;

/// The number of sensors that determine the position of a joint.
std::ptrdiff_t sensors_needed(const erp::Joint& joint) {
  switch (joint.type) {
    case erp::JointType::fixed:
      return 0;
    case erp::JointType::revolute:
      return 1;
    case erp::JointType::spherical:
      return 3;
    case erp::JointType::free:
      break;
  }
  return 6;
}

bool rotates(erp::JointType type) {
  return type == erp::JointType::revolute || type == erp::JointType::spherical;
}

std::vector<JointReading> readings_of(const Pose& pose) {
  std::vector<JointReading> readings(pose.size());
  for (std::size_t j = 0; j < pose.size(); ++j) readings[j].position = pose[j];
  return readings;
}

/// Tensions between two sets: linear during `ramp_s`.
std::vector<SetPoint> set_points(const std::vector<double>& from_N, const std::vector<double>& to_N,
                                 double fraction) {
  std::vector<SetPoint> points;
  for (std::size_t a = 0; a < to_N.size(); ++a)
    points.push_back(
        {erp::Mode::force, from_N[a] + std::min(1.0, fraction) * (to_N[a] - from_N[a])});
  return points;
}

}  // namespace

/// The linearized least-squares problem; unknowns: steps of the poses, then the offsets.
struct HomingEstimate::Problem {
  std::span<const HomingSnapshot> snapshots;
  std::span<const Pose> start;
  const std::vector<bool>& known;
  Eigen::Index poses;  ///< number of unknowns of the poses
  Matrix normal;
  Vector gradient;
};

HomingEstimate::HomingEstimate(const erp::Robot& robot) : robot_(robot), model_(robot) {
  for (std::size_t a = 0; a < robot.actuators.size(); ++a)
    laws_.push_back(TendonLaw::at_rest(robot.actuators[a].tendon, robot.actuators[a].spindle,
                                       model_.length_m()[static_cast<Eigen::Index>(a)]));
  for (const auto& joint : model_.tree().joints) {
    const auto sensors =
        std::ranges::count(robot.joint_sensors, joint.name, &erp::JointSensor::joint);
    measured_.push_back(sensors >= sensors_needed(joint));
    if (!measured_.back()) unmeasured_.push_back(joint.name);
  }
}

std::vector<Pose> HomingEstimate::simulate(std::span<const std::vector<double>> tension_N,
                                           double ramp_s, double each_s) const {
  SimulatedRobot twin(robot_);
  std::vector<Pose> poses;
  std::vector<double> last_N(robot_.actuators.size(), 0.0);
  for (const auto& next_N : tension_N) {
    for (double time_s = 0; time_s < each_s; time_s += tick_s)
      twin.tick(set_points(last_N, next_N, time_s / ramp_s));
    last_N = next_N;
    Pose& pose = poses.emplace_back();
    for (const auto& joint : twin.world().joints()) pose.push_back(joint.position);
  }
  return poses;
}

/// Replaces the positions of joints that sensors measure completely: the angle of a revolute joint; of
/// a spherical one, its rotation vector.
void HomingEstimate::set_measured(Pose& pose, const HomingSnapshot& snapshot,
                                  const Pose& starting) const {
  const auto& joints = model_.tree().joints;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (!measured_[j] || !rotates(joints[j].type)) continue;
    std::array<double, 3> rotation_rad{};
    for (std::size_t s = 0; s < robot_.joint_sensors.size(); ++s) {
      const auto& sensor = robot_.joint_sensors[s];
      if (sensor.joint != joints[j].name) continue;
      if (!snapshot.joint_rad[s])
        throw std::runtime_error("the sensor of joint " + sensor.joint + " has no valid reading");
      rotation_rad[sensor.about ? static_cast<std::size_t>(*sensor.about) : 0] =
          *snapshot.joint_rad[s];
    }
    if (joints[j].type == erp::JointType::revolute) pose[j][0] = rotation_rad[0];
    else pose[j] = displaced(joints[j].type, starting[j], rotation_rad);
  }
}

/// Builds the normal equations; returns the sum of squares.
double HomingEstimate::linearize(Problem& problem, std::span<const Pose> poses,
                                 const Vector& offset_m) {
  const Eigen::Index n = model_.coordinates(), m = model_.length_m().size();
  problem.normal.setZero(problem.poses + m, problem.poses + m);
  problem.gradient.setZero(problem.poses + m);
  double cost = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Eigen::Index first = static_cast<Eigen::Index>(k) * n;
    model_.place(readings_of(poses[k]));
    for (Eigen::Index a = 0; a < m; ++a) {
      const auto i = static_cast<std::size_t>(a);
      const HomingSnapshot& s = problem.snapshots[k];
      if (s.tension_N[i] < min_taut_N) continue;
      const double error = (model_.length_m()[a] - laws_[i].rest_m - s.line_m[i] - offset_m[a] -
                            laws_[i].spring.stretch_m(s.tension_N[i])) /
                           sigma_line_m;
      Vector row = Vector::Zero(problem.poses + m);
      row.segment(first, n) = model_.jacobian().row(a).transpose() / sigma_line_m;
      if (!problem.known[i]) row[problem.poses + a] = -1 / sigma_line_m;
      problem.normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
      problem.gradient += error * row;
      cost += error * error;
    }
    for (std::size_t j = 0; j < poses[k].size(); ++j) {
      const int at = model_.skeleton().first_of(static_cast<int>(j));
      const auto type = model_.tree().joints[j].type;
      if (at < 0) continue;
      const auto away = displacement(type, problem.start[k][j], poses[k][j]);
      // Joints of other types stay where they are.
      const double sigma = !rotates(type) ? 1e-9
                           : measured_[j] ? sigma_sensor_rad
                                          : sigma_start_rad;
      for (int d = 0; d < coordinates_of(type); ++d) {
        const double error = d < 3 ? away[static_cast<std::size_t>(d)] / sigma : 0;
        problem.normal(first + at + d, first + at + d) += 1 / (sigma * sigma);
        problem.gradient[first + at + d] += error / sigma;
        cost += error * error;
      }
    }
  }
  for (Eigen::Index a = 0; a < m; ++a)
    if (problem.known[static_cast<std::size_t>(a)])
      problem.normal(problem.poses + a, problem.poses + a) = 1;
  return cost;
}

std::vector<Pose> HomingEstimate::moved(std::span<const Pose> poses, const Vector& step) const {
  std::vector<Pose> result(poses.begin(), poses.end());
  for (std::size_t k = 0; k < poses.size(); ++k)
    for (std::size_t j = 0; j < poses[k].size(); ++j) {
      const auto type = model_.tree().joints[j].type;
      const int at = model_.skeleton().first_of(static_cast<int>(j));
      if (at < 0 || !rotates(type)) continue;
      std::array<double, 3> rotation_rad{};
      for (int d = 0; d < coordinates_of(type); ++d)
        rotation_rad[static_cast<std::size_t>(d)] =
            step[static_cast<Eigen::Index>(k) * model_.coordinates() + at + d];
      result[k][j] = displaced(type, poses[k][j], rotation_rad);
    }
  return result;
}

HomedLines HomingEstimate::find(std::span<const HomingSnapshot> snapshots,
                                const std::vector<bool>& known, std::vector<Pose> start) {
  const Pose starting = starting_pose(robot_);
  for (std::size_t k = 0; k < snapshots.size(); ++k) set_measured(start[k], snapshots[k], starting);
  const Eigen::Index m = model_.length_m().size();
  Problem problem{snapshots, start,
                  known,     static_cast<Eigen::Index>(snapshots.size()) * model_.coordinates(),
                  {},        {}};
  std::vector<Pose> poses = start;
  Vector offset_m = Vector::Zero(m);
  double cost = linearize(problem, poses, offset_m), damping = 1e-6;
  for (int step = 0; step < max_steps && damping < 1e6; ++step) {
    Problem trial = problem;
    trial.normal.diagonal() *= 1 + damping;
    const Vector change =
        trial.normal.selfadjointView<Eigen::Lower>().ldlt().solve(-problem.gradient);
    const auto trial_poses = moved(poses, change);
    const Vector trial_offset_m = offset_m + change.tail(m);
    const double trial_cost = linearize(trial, trial_poses, trial_offset_m);
    if (!(trial_cost < cost)) {
      damping = std::max(1e-6, damping) * 10;
      continue;
    }
    const bool is_done = cost - trial_cost < 1e-9 * cost;
    poses = trial_poses, offset_m = trial_offset_m, cost = trial_cost;
    problem.normal = trial.normal, problem.gradient = trial.gradient;
    damping /= 10;
    if (is_done) break;
  }
  const Matrix full = problem.normal.selfadjointView<Eigen::Lower>();
  const Vector variance_m2 = full.inverse().diagonal().tail(m);
  HomedLines lines;
  for (Eigen::Index a = 0; a < m; ++a) {
    const bool is_known = known[static_cast<std::size_t>(a)];
    lines.offset_m.push_back(is_known ? 0 : offset_m[a]);
    lines.sigma_m.push_back(is_known ? 0 : std::sqrt(variance_m2[a]));
  }
  return lines;
}

}  // namespace sim
