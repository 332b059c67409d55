#include "sim/gap/residuals/skeletal.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace sim::residuals {
namespace {

constexpr double spacing_rad = 1e-3;  // of the points of a table; chosen

std::pair<double, double> range_of(const Signal& signal) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double x : signal)
    if (!std::isnan(x)) low = std::min(low, x), high = std::max(high, x);
  return {low, high};
}

Vec3 gravity_of(const erp::Robot& robot) {
  const auto g = robot.gravity_m_per_s2();
  return {g[0], g[1], g[2]};
}

}  // namespace

void PathTrace::smooth(double period_s, double speed_half_width_s) {
  constexpr double mean_half_width_s = 0.03;  // chosen: as the windows of the stages
  rate_m_per_s = Bump(speed_half_width_s, period_s).rates(length_m);
  const Bump wide(mean_half_width_s, period_s);
  mean_m = length_m;
  for (std::size_t k = wide.reach(); k + wide.reach() < length_m.size(); ++k)
    mean_m[k] = wide.mean(length_m, k);
}

bool was_measured(const JointSignals& joint, erp::JointType type) {
  if (type == erp::JointType::revolute) return !joint.angle_rad.empty();
  if (type == erp::JointType::spherical) return !joint.quaternion[3].empty();
  return type == erp::JointType::fixed;
}

Skeletal::Skeletal(const erp::Robot& robot) : tree_(robot), model_(tree_, gravity_of(robot)) {
  std::vector<JointReading> initial_pose;
  for (const erp::Joint& joint : tree_.joints) initial_pose.push_back(initial_reading(joint));
  model_.place(initial_pose);
  for (const erp::Actuator& actuator : robot.actuators) {
    loads_.push_back(-1);
    if (actuator.tendon.path.empty()) {  // a drive
      tendons_.emplace_back(std::nullopt);
      for (std::size_t j = 0; j < tree_.joints.size(); ++j)
        if (tree_.joints[j].name == actuator.name) loads_.back() = static_cast<int>(j);
      continue;
    }
    const Routing routing(actuator.tendon, tree_.names);
    Tendon tendon{routing, levers_of(routing, model_), routing.solve(model_.poses()), 0, {}};
    tendon.initial_length_m = tendon.shape.length_m;
    for (int j = 0; j < static_cast<int>(tree_.joints.size()); ++j)
      for (const int c : tendon.levers.coordinates)
        if (c >= model_.first_of(j) && model_.first_of(j) >= 0 &&
            c < model_.first_of(j) + coordinates_of(tree_.joints[std::size_t(j)].type))
          if (tendon.crossed.empty() || tendon.crossed.back() != j) tendon.crossed.push_back(j);
    tendons_.push_back(std::move(tendon));
  }
}

bool Skeletal::measured(std::span<const JointSignals> joints) const {
  for (std::size_t j = 0; j < tree_.joints.size(); ++j)
    if (!was_measured(joints[j], tree_.joints[j].type)) return false;
  return true;
}

std::vector<std::size_t> Skeletal::crossed_by(std::size_t actuator) const {
  if (!tendons_[actuator])
    return loads_[actuator] < 0 ? std::vector<std::size_t>{}
                                : std::vector{std::size_t(loads_[actuator])};
  return {tendons_[actuator]->crossed.begin(), tendons_[actuator]->crossed.end()};
}

JointReading Skeletal::reading(const JointSignals& joint, std::size_t j, std::size_t row) const {
  JointReading reading = initial_reading(tree_.joints[j]);
  if (!was_measured(joint, reading.type)) return reading;
  if (reading.type == erp::JointType::revolute) reading.position[0] = joint.angle_rad[row];
  if (reading.type == erp::JointType::spherical)
    for (std::size_t k = 0; k < 4; ++k) reading.position[k] = joint.quaternion[k][row];
  return reading;
}

const Signal* Skeletal::only_angle(std::size_t actuator,
                                   std::span<const JointSignals> joints) const {
  const Tendon& tendon = *tendons_[actuator];
  if (tendon.crossed.size() != 1) return nullptr;
  const auto j = static_cast<std::size_t>(tendon.crossed[0]);
  if (tree_.joints[j].type != erp::JointType::revolute) return nullptr;
  const Signal& angle = joints[j].angle_rad;
  const auto [low, high] = range_of(angle);
  return high - low < spacing_rad * double(angle.size()) ? &angle : nullptr;
}

/// Interpolates linearly. If the moment arm changes by 0.1 m/rad, the error is 10 nm.
PathTrace Skeletal::path_by_table(std::size_t actuator, const Signal& angle_rad) {
  Tendon& tendon = *tendons_[actuator];
  const auto [low, high] = range_of(angle_rad);
  PathTrace trace{Signal(angle_rad.size(), recording::not_taken),
                  Signal(angle_rad.size(), recording::not_taken)};
  if (low > high) return trace;
  std::vector<JointReading> posture;
  for (const erp::Joint& joint : tree_.joints) posture.push_back(initial_reading(joint));
  const auto points = static_cast<std::size_t>((high - low) / spacing_rad) + 2;
  std::vector<double> length(points), wrap(points);
  for (std::size_t n = 0; n < points; ++n) {
    posture[std::size_t(tendon.crossed[0])].position[0] = low + spacing_rad * double(n);
    model_.place(posture);
    tendon.routing.solve(model_.poses(), tendon.shape);
    length[n] = tendon.shape.length_m, wrap[n] = bend_rad(tendon.shape);
  }
  for (std::size_t k = 0; k < angle_rad.size(); ++k) {
    if (std::isnan(angle_rad[k])) continue;
    const double position = (angle_rad[k] - low) / spacing_rad;
    const auto n = std::min(static_cast<std::size_t>(position), points - 2);
    trace.length_m[k] = std::lerp(length[n], length[n + 1], position - double(n));
    trace.wrap_rad[k] = std::lerp(wrap[n], wrap[n + 1], position - double(n));
  }
  return trace;
}

std::vector<PathTrace> Skeletal::paths(std::span<const JointSignals> joints, std::size_t rows,
                                       std::span<const std::size_t> actuators) {
  std::vector<PathTrace> traces(actuators.size());
  std::vector<std::size_t> solved;  // indices of the tendons that are solved row by row
  for (std::size_t n = 0; n < actuators.size(); ++n) {
    const std::size_t a = actuators[n];
    if (const int load = loads_[a]; load >= 0) {
      traces[n] = {joints[std::size_t(load)].angle_rad, Signal(rows, 0.0)};
      for (double& length : traces[n].length_m) length = -length;
    }
    if (!tendons_[a] || std::ranges::any_of(tendons_[a]->crossed, [&](int j) {
          return !was_measured(joints[std::size_t(j)], tree_.joints[std::size_t(j)].type);
        }))
      continue;
    if (const Signal* angle = only_angle(a, joints)) {
      traces[n] = path_by_table(a, *angle);
      continue;
    }
    traces[n] = {Signal(rows, recording::not_taken), Signal(rows, recording::not_taken)};
    solved.push_back(n);
  }
  std::vector<JointReading> posture(tree_.joints.size());
  for (std::size_t k = 0; k < rows && !solved.empty(); ++k) {
    bool valid = true;
    for (std::size_t j = 0; j < posture.size(); ++j) {
      posture[j] = reading(joints[j], j, k);
      for (const double p : posture[j].position) valid &= !std::isnan(p);
    }
    if (!valid) continue;
    model_.place(posture);
    for (const std::size_t n : solved) {
      Tendon& tendon = *tendons_[actuators[n]];
      tendon.routing.solve(model_.poses(), tendon.shape);
      traces[n].length_m[k] = tendon.shape.length_m, traces[n].wrap_rad[k] = bend_rad(tendon.shape);
    }
  }
  return traces;
}

Motion Skeletal::motion(std::span<const JointSignals> joints, const Bump& bump,
                        std::size_t row) const {
  Motion motion{{}, Eigen::VectorXd::Zero(model_.coordinates()), true};
  for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
    JointReading r = initial_reading(tree_.joints[j]);
    const int first = model_.first_of(static_cast<int>(j));
    if (r.type == erp::JointType::revolute) {
      const Signal& angle = joints[j].angle_rad;
      r.position[0] = bump.mean(angle, row), r.velocity_rad_per_s[0] = bump.rate(angle, row);
      if (first >= 0) motion.acceleration[first] = bump.acceleration(angle, row);
    }
    if (r.type == erp::JointType::spherical) {
      Eigen::Vector4d q, rate, second_rate;  // x y z w
      for (int k = 0; k < 4; ++k) {
        const Signal& part = joints[j].quaternion[std::size_t((k + 1) % 4)];
        q[k] = bump.mean(part, row), rate[k] = bump.rate(part, row);
        second_rate[k] = bump.acceleration(part, row);
      }
      const double length = q.norm();
      const Eigen::Quaterniond rotation(Eigen::Vector4d(q / length));
      const auto in_child_frame = [&](const Eigen::Vector4d& d) -> Eigen::Vector3d {
        return 2 * (rotation.conjugate() * Eigen::Quaterniond(Eigen::Vector4d(d / length))).vec();
      };
      const Eigen::Vector3d omega = in_child_frame(rate), alpha = in_child_frame(second_rate);
      r.position = {rotation.w(), rotation.x(), rotation.y(), rotation.z()};
      r.velocity_rad_per_s = {omega.x(), omega.y(), omega.z()};
      if (first >= 0) motion.acceleration.segment<3>(first) = alpha;
    }
    for (const double p : r.position) motion.valid &= !std::isnan(p);
    motion.joints.push_back(r);
  }
  return motion;
}

Eigen::VectorXd Skeletal::inverse(const Motion& motion) {
  model_.place(motion.joints);
  model_.inverse(motion.acceleration, torque_);
  return torque_;
}

std::vector<Eigen::MatrixXd> Skeletal::gradients(std::span<const Motion> motions,
                                                 std::span<const std::size_t> actuators) {
  const auto columns = static_cast<Eigen::Index>(motions.size());
  std::vector<Eigen::MatrixXd> gradients(
      actuators.size(),
      Eigen::MatrixXd::Constant(model_.coordinates(), columns, recording::not_taken));
  for (Eigen::Index k = 0; k < columns; ++k) {
    const Motion& motion = motions[std::size_t(k)];
    if (!motion.valid) continue;
    model_.place(motion.joints);
    for (std::size_t n = 0; n < actuators.size(); ++n) {
      if (!tendons_[actuators[n]]) {
        gradients[n].col(k).setZero();
        if (const int load = loads_[actuators[n]]; load >= 0)
          gradients[n](model_.first_of(load), k) = -1;
        continue;
      }
      Tendon& tendon = *tendons_[actuators[n]];
      tendon.routing.solve(model_.poses(), tendon.shape);
      length_gradient(tendon.shape, tendon.levers, model_, gradient_);
      gradients[n].col(k) = gradient_;
    }
  }
  return gradients;
}

}  // namespace sim::residuals
