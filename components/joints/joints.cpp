#include "components/joints/joints.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace joints {
namespace {

bool is_movable(const erp::Joint& joint) {
  return joint.type == erp::JointType::revolute || joint.type == erp::JointType::spherical;
}

constexpr double min_squared_norm = 0.5;  // chosen: of a quaternion, nominally 1

/// Reads position and velocity of a sample. False if not finite, or if a quaternion is near zero.
template <class Sample>
bool read_sample(const Sample& sample, sim::JointReading& reading) {
  double squared_norm = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    reading.position[i] = sample.position[i];
    squared_norm += sample.position[i] * sample.position[i];
  }
  double velocity_sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    velocity_sum += std::abs(reading.velocity_rad_per_s[i] = sample.velocity_rad_per_s[i]);
  const bool is_rotation =
      reading.type != erp::JointType::spherical || squared_norm > min_squared_norm;
  return is_rotation && std::isfinite(squared_norm) && std::isfinite(velocity_sum);
}

void extrapolate(sim::JointReading& reading, std::int64_t by_ns) {
  constexpr std::int64_t max_extrapolation_ns = 50'000'000;  // chosen
  if (by_ns == 0 || std::abs(by_ns) > max_extrapolation_ns) return;
  const double by_s = 1e-9 * static_cast<double>(by_ns);
  auto rotation_rad = reading.velocity_rad_per_s;
  for (double& angle : rotation_rad) angle *= by_s;
  reading.position = sim::displaced(reading.type, reading.position, rotation_rad);
}

}  // namespace

Names::Names(const erp::Robot& robot) : joints_(robot.joints()) {}

/// Calls read_one(j, sample) for each movable joint. Messages are mostly in the robot's own order.
template <class Message, class Take>
bool Names::for_each_movable(const Message& message, Take read_one) const {
  const auto samples = erp::samples(message.joints);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (!is_movable(joints_[j])) continue;
    const auto matches = [&](const auto& sample) { return joints_[j].name == sample.name; };
    const auto match = j < samples.size() && matches(samples[j])
                           ? samples.begin() + static_cast<long>(j)
                           : std::ranges::find_if(samples, matches);
    if (match == samples.end() || !read_one(j, *match)) return false;
  }
  return true;
}

bool Names::read(const erp::JointState& message, std::vector<sim::JointReading>& readings) const {
  readings.resize(joints_.size());
  for (std::size_t j = 0; j < joints_.size(); ++j) readings[j] = sim::initial_reading(joints_[j]);
  return for_each_movable(
      message, [&](std::size_t j, const auto& sample) { return read_sample(sample, readings[j]); });
}

bool Names::read(const erp::JointTarget& message, std::vector<sim::JointMotion>& motions) const {
  motions.resize(joints_.size());
  for (std::size_t j = 0; j < joints_.size(); ++j) motions[j] = {sim::initial_reading(joints_[j]), {}};
  return for_each_movable(message, [&](std::size_t j, const auto& sample) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
      sum += std::abs(motions[j].acceleration_rad_per_s2[i] = sample.acceleration_rad_per_s2[i]);
    return read_sample(sample, motions[j].now) && std::isfinite(sum);
  });
}

bool Names::read(const erp::JointState& message, std::int64_t at_ns,
                 std::vector<sim::JointReading>& readings) const {
  if (!read(message, readings)) return false;
  for (auto& reading : readings) extrapolate(reading, at_ns - message.stamp_ns);
  return true;
}

bool Names::read(const erp::JointTarget& message, std::int64_t at_ns,
                 std::vector<sim::JointMotion>& motions) const {
  if (!read(message, motions)) return false;
  for (auto& motion : motions) extrapolate(motion.now, at_ns - message.stamp_ns);
  return true;
}

void Names::write(std::span<const sim::JointMotion> motions, erp::JointTarget& message) const {
  message.joints._length = 0;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (!is_movable(joints_[j])) continue;
    erp::JointTargetSample sample{};
    erp::assign(sample.name, joints_[j].name);
    sample.dof = static_cast<std::uint8_t>(sim::coordinates_of(joints_[j].type));
    std::ranges::copy(motions[j].now.position, sample.position);
    std::ranges::copy(motions[j].now.velocity_rad_per_s, sample.velocity_rad_per_s);
    std::ranges::copy(motions[j].acceleration_rad_per_s2, sample.acceleration_rad_per_s2);
    erp::append(message.joints, sample);
  }
}

void Names::write(std::span<const sim::JointReading> readings, const Eigen::VectorXd& variance_rad2,
                  const sim::SkeletonModel& model, erp::JointState& message,
                  const std::vector<bool>& known) const {
  message.joints._length = 0;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const sim::JointReading& now = readings[j];
    const int first = model.first_of(static_cast<int>(j));
    const int dof = std::min(sim::coordinates_of(now.type), 3);
    if (first < 0 || (!known.empty() && !known[j])) continue;
    erp::JointStateSample sample{};
    erp::assign(sample.name, joints_[j].name);
    sample.dof = static_cast<std::uint8_t>(dof);
    std::ranges::copy(now.position, sample.position);
    std::ranges::copy(now.velocity_rad_per_s, sample.velocity_rad_per_s);
    for (int d = 0; d < dof; ++d) sample.variance_rad2[d] = variance_rad2[first + d];
    erp::append(message.joints, sample);
  }
}

double largest_rotation_rad(std::span<const sim::JointReading> a,
                            std::span<const sim::JointMotion> b) {
  double largest_rad = 0;
  for (std::size_t j = 0; j < a.size(); ++j) {
    const auto rotation = sim::displacement(a[j].type, a[j].position, b[j].now.position);
    largest_rad = std::max(largest_rad, std::hypot(rotation[0], rotation[1], rotation[2]));
  }
  return largest_rad;
}

sim::CatchUp catch_up(std::span<const sim::JointReading> now,
                      std::span<const sim::JointMotion> desired, double rad_per_s) {
  constexpr double min_duration_s =
      0.2;  // chosen: shortest transition; also limits the deceleration
  double top_rad_per_s = 0;
  for (const auto& joint : now)
    top_rad_per_s = std::max(top_rad_per_s, sim::vec(joint.velocity_rad_per_s).norm());
  const double travel_s =
      sim::minimum_jerk_top_speed * largest_rotation_rad(now, desired) / rad_per_s;
  return {now, desired,
          std::max({travel_s, min_duration_s * top_rad_per_s / rad_per_s, min_duration_s})};
}

}  // namespace joints
