#include "components/plant/zeros.hpp"

#include <algorithm>
#include <cmath>

#include "interfaces/xml/values.hpp"

namespace plant {
namespace {

/// Time after the first report of an ECU in which the ECUs of the same robot have reported too.
constexpr std::int64_t settle_ns = 100'000'000;            // chosen: 50 frames
constexpr std::int64_t joints_timeout_ns = 1'000'000'000;  // chosen
/// Largest deviation of a joint from the starting pose. Chosen: 3 degrees.
constexpr double max_deviation_rad = 0.052;

const erp::Potentiometer* potentiometer_of(const erp::Robot& robot, const std::string& actuator) {
  const auto match =
      std::ranges::find(robot.potentiometers, actuator, &erp::Potentiometer::actuator);
  return match == robot.potentiometers.end() ? nullptr : &*match;
}

/// Spherical joints start with parallel frames, at 0.
double start_rad_of(const erp::Robot& robot, const erp::JointSensor& sensor) {
  if (sensor.about) return 0;
  for (const auto& joint : robot.joints())
    if (joint.name == sensor.joint) return joint.initial_rad;
  return 0;
}

}  // namespace

Zeros::Zeros(const erp::Robot& robot, const std::vector<double>& rad_per_count)
    : candidates_(robot.actuators.size()),
      starts_in_pose_(robot.switched_on == erp::SwitchedOn::starting_pose) {
  for (std::size_t i = 0; i < robot.actuators.size(); ++i) {
    const auto& actuator = robot.actuators[i];
    names_.push_back(actuator.name);
    zeros_.emplace_back(actuator, rad_per_count[i], potentiometer_of(robot, actuator.name));
  }
  for (const auto& sensor : robot.joint_sensors)
    joints_.push_back({erp::sample_name(sensor), start_rad_of(robot, sensor), {}});
}

void Zeros::observe(std::size_t actuator, const erp::EcuChannelSample& counts,
                    std::int64_t now_ns) {
  const auto state = static_cast<ecu_state>(counts.state);
  has_moved_ = has_moved_ || state == ECU_STATE_ARMED || state == ECU_STATE_RUNNING;
  Candidate& candidate = candidates_[actuator];
  if (!std::exchange(candidate.is_observed, true))
    candidate = {starts_in_pose_ && !counts.zero_known && state == ECU_STATE_BOOT, true, now_ns};
  report(actuator,
         zeros_[actuator].observe(counts.zero_known, state, counts.encoder_counts, now_ns));
}

bool Zeros::is_waiting_for_joints(std::int64_t now_ns) const {
  return std::ranges::any_of(joints_, [](const auto& j) { return !j.reading_rad; }) &&
         std::ranges::none_of(candidates_, [&](const Candidate& c) {
           return c.is_open && now_ns - c.since_ns > joints_timeout_ns;
         });
}

/// The joint that is farthest from the starting pose, if it is too far; otherwise empty.
std::string Zeros::deviation() const {
  std::string text;
  double largest_rad = max_deviation_rad;
  for (const auto& joint : joints_) {
    const double difference_rad = joint.reading_rad ? *joint.reading_rad - joint.start_rad : 0;
    if (std::abs(difference_rad) <= largest_rad) continue;
    largest_rad = std::abs(difference_rad);
    text = joint.joint + " is at " + xml::write_number(*joint.reading_rad) + " rad, " +
           xml::write_number(joint.start_rad) + " rad in the starting pose";
  }
  return text;
}

/// An ECU that was in boot when it was first seen, before any ECU of the robot was armed, has just been
/// switched on.
void Zeros::update(std::int64_t now_ns) {
  if (!starts_in_pose_) return;
  if (has_moved_) starts_in_pose_ = false;
  if (!starts_in_pose_ || is_waiting_for_joints(now_ns)) return;
  const std::string reason = deviation();
  for (std::size_t i = 0; i < zeros_.size(); ++i) {
    Candidate& candidate = candidates_[i];
    if (!candidate.is_open || now_ns - candidate.since_ns < settle_ns) continue;
    candidate.is_open = false;
    if (reason.empty() && !zeros_[i].has_potentiometer())
      zeros_[i].set(0, "the starting pose", now_ns);
    else if (!reason.empty() && !std::exchange(reported_deviation_, true))
      notices_.push_back(
          {erp::Severity::warning, "", "not_in_starting_pose",
           reason + ": the zeros of the encoders stay unknown; move the robot there and switch "
                    "its ECUs off and on, or run erp home"});
  }
}

void Zeros::report(std::size_t actuator, Zero::Change change) {
  const Zero& zero = zeros_[actuator];
  const std::string& name = names_[actuator];
  const bool will_be_set = zero.has_potentiometer() || candidates_[actuator].is_open;
  switch (change) {
    case Zero::Change::none:
      return;
    case Zero::Change::set:
      return notices_.push_back({erp::Severity::info, name, "zero_set",
                                 "the zero of its encoder is set from " + zero.source()});
    case Zero::Change::unconfirmed:
      return notices_.push_back({erp::Severity::warning, name, "zero_unknown",
                                 "its ECU did not accept the zero of its encoder from " +
                                     zero.source() + "; switch the actuator off and repeat it"});
    case Zero::Change::lost:
      return notices_.push_back(
          {will_be_set ? erp::Severity::info : erp::Severity::warning, name, "zero_unknown",
           std::string("the zero of its encoder is unknown after a reset of its ECU: length "
                       "references are refused") +
               (will_be_set ? " until it is set" : "; set it with: erp home")});
  }
}

void Zeros::append_next(erp::EcuParameter& message, std::int64_t now_ns) {
  for (Zero& zero : zeros_) zero.append_next(message, now_ns);
}

}  // namespace plant
