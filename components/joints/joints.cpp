#include "components/joints/joints.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace joints {
namespace {

bool turns(const erp::Joint& joint) {
  return joint.type == erp::JointType::revolute || joint.type == erp::JointType::spherical;
}

/// Reads position and velocity of any sample. False: not finite, or a quaternion near zero.
template <class Sample>
bool read_sample(const Sample& sample, sim::JointReading& reading) {
  double size = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    reading.position[i] = sample.position[i];
    size += sample.position[i] * sample.position[i];
  }
  double speed = 0;
  for (std::size_t i = 0; i < 3; ++i)
    speed += std::abs(reading.velocity_rad_per_s[i] = sample.velocity_rad_per_s[i]);
  const bool turned = reading.type != erp::JointType::spherical || size > 0.5;
  return turned && std::isfinite(size) && std::isfinite(speed);
}

void extrapolate(sim::JointReading& reading, std::int64_t by_ns) {
  constexpr std::int64_t farthest_ns = 50'000'000;  // chosen
  if (by_ns == 0 || std::abs(by_ns) > farthest_ns) return;
  const double by_s = 1e-9 * static_cast<double>(by_ns);
  auto way = reading.velocity_rad_per_s;
  for (double& turn : way) turn *= by_s;
  reading.position = sim::displaced(reading.type, reading.position, way);
}

}  // namespace

Names::Names(const erp::Robot& robot) : joints_(robot.joints()) {}

/// Calls read_one(j, sample) for each movable joint. Messages are mostly in the robot's own order.
template <class Message, class Take>
bool Names::each(const Message& message, Take read_one) const {
  const auto samples = erp::samples(message.joints);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (!turns(joints_[j])) continue;
    const auto matches = [&](const auto& sample) { return joints_[j].name == sample.name; };
    const auto found = j < samples.size() && matches(samples[j])
                           ? samples.begin() + static_cast<long>(j)
                           : std::ranges::find_if(samples, matches);
    if (found == samples.end() || !read_one(j, *found)) return false;
  }
  return true;
}

bool Names::read(const erp::JointState& message, std::vector<sim::JointReading>& readings) const {
  readings.resize(joints_.size());
  for (std::size_t j = 0; j < joints_.size(); ++j) readings[j] = sim::initial_reading(joints_[j]);
  return each(message,
              [&](std::size_t j, const auto& sample) { return read_sample(sample, readings[j]); });
}

bool Names::read(const erp::JointTarget& message, std::vector<sim::JointMotion>& motions) const {
  motions.resize(joints_.size());
  for (std::size_t j = 0; j < joints_.size(); ++j)
    motions[j] = {sim::initial_reading(joints_[j]), {}};
  return each(message, [&](std::size_t j, const auto& sample) {
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
    if (!turns(joints_[j])) continue;
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
    const int turns = std::min(sim::coordinates_of(now.type), 3);
    if (first < 0 || (!known.empty() && !known[j])) continue;
    erp::JointStateSample sample{};
    erp::assign(sample.name, joints_[j].name);
    sample.dof = static_cast<std::uint8_t>(turns);
    std::ranges::copy(now.position, sample.position);
    std::ranges::copy(now.velocity_rad_per_s, sample.velocity_rad_per_s);
    for (int d = 0; d < turns; ++d) sample.variance_rad2[d] = variance_rad2[first + d];
    erp::append(message.joints, sample);
  }
}

double apart_rad(std::span<const sim::JointReading> a, std::span<const sim::JointMotion> b) {
  double most = 0;
  for (std::size_t j = 0; j < a.size(); ++j) {
    const auto way = sim::displacement(a[j].type, a[j].position, b[j].now.position);
    most = std::max(most, std::hypot(way[0], way[1], way[2]));
  }
  return most;
}

sim::CatchUp catch_up(std::span<const sim::JointReading> now,
                      std::span<const sim::JointMotion> desired, double rad_per_s) {
  constexpr double least_s = 0.2;  // chosen: shortest transition; also limits the deceleration
  double top = 0;
  for (const auto& joint : now) top = std::max(top, sim::vec(joint.velocity_rad_per_s).norm());
  const double way_s = sim::minimum_jerk_top_speed * apart_rad(now, desired) / rad_per_s;
  return {now, desired, std::max({way_s, least_s * top / rad_per_s, least_s})};
}

}  // namespace joints
