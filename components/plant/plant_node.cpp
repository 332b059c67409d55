#include "components/plant/plant_node.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "firmware/core/parameters.h"
#include "sim/control/gain_design.hpp"

namespace plant {
namespace {

constexpr std::int64_t device_check_ns = 1'000'000;  // device_lost follows 50 … 51 ms of silence
constexpr std::uint64_t owner_period_frames = 50;    // owners are published at 10 Hz
constexpr std::uint64_t gains_period_frames = 50;    // between attempts to set gains

/// All gains of an ECU channel, designed from robot.xml; the last value commits the set.
std::vector<erp::EcuParameterValue> gain_set(const erp::Robot& robot,
                                             const erp::Actuator& actuator) {
  const auto designed = sim::design_parameters(robot, actuator, {});
  std::vector<erp::EcuParameterValue> values;
  for (std::size_t i = 0; i < designed.size(); ++i)
    values.push_back({static_cast<std::uint8_t>(actuator.ecu),
                      static_cast<std::uint8_t>(actuator.channel), static_cast<std::uint8_t>(i),
                      i + 1 == designed.size(), designed[i]});
  return values;
}

/// The index of a gain by its name in firmware/core/parameters.h, e.g. `length_gain_V_per_rad`.
std::optional<std::size_t> gain_index(std::string_view name) {
#define ERP_GAIN_NAME(id, text) std::string_view(#text),
  constexpr std::array names{ECU_PARAMETERS(ERP_GAIN_NAME)};
#undef ERP_GAIN_NAME
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return i;
  return std::nullopt;
}

/// Sets `commit` on the last value of each channel, so that the channel applies its gains at once.
void commit_last(erp::EcuParameter& parameters) {
  std::set<std::pair<int, int>> committed;
  for (auto i = parameters.values._length; i-- > 0;) {
    auto& value = parameters.values._buffer[i];
    value.commit = committed.insert({value.ecu, value.channel}).second;
  }
}

}  // namespace

PlantNode::PlantNode(const Params& params, const erp::Robot& robot, node::Node& node)
    : node_(node),
      plant_(params, robot),
      sensor_out_(node.advertise<erp::SensorFrame>()),
      ecu_out_(node.advertise<erp::EcuCommand>()),
      parameter_out_(node.advertise<erp::EcuParameter>()),
      owner_out_(node.advertise<erp::ActuatorOwner>()) {
  for (const auto& actuator : robot.actuators) {
    names_.push_back(actuator.name);
    gains_.push_back(gain_set(robot, actuator));
  }
  command_in_ = &node.subscribe<erp::ActuatorCommand>([this](const auto& m) { on_command(m); });
  node.subscribe<erp::GainCommand>([this](const auto& m) { on_gains(m); });
  node.subscribe<erp::EcuFrame>([this](const auto& m) { on_frame(m); });
  node.every(device_check_ns, [this] {
    if (node_.clock().lockstep() ? answer_pending_ && all_answered()
                                 : plant_.check_device(node_.clock().now_ns()))
      answer();
  });
}

void PlantNode::on_frame(const erp::EcuFrame& frame) {
  if (answer_pending_ && !node_.clock().lockstep()) answer();
  // A lockstep device repeats a frame whose answer it missed.
  if (frame_received_ && node_.clock().lockstep() && frame.sequence == current_frame_)
    return repeat_answer();
  node_.clock().advance(frame.stamp_ns);
  current_frame_ = frame.sequence;
  frame_received_ = true;
  answer_pending_ = true;
  pending_since_ns_ = node::monotonic_ns();
  auto sensed = plant_.sense(frame, node_.clock().now_ns());
  sensor_out_.publish_numbered(sensed);
  if (frame_count_++ % gains_period_frames == 0) send_gains();
  if (frame_count_ % owner_period_frames == 1) publish_owners();
  node_.count_step(frame.stamp_ns);
  if (node_.clock().lockstep() && all_answered()) answer();
}

void PlantNode::on_command(const erp::ActuatorCommand& command) {
  plant_.receive(command, node_.clock().now_ns());
  const auto previous_answer = std::find_if(answers_.begin(), answers_.end(), [&](const Answer& a) {
    return a.controller == command.controller;
  });
  if (previous_answer == answers_.end()) answers_.push_back({command.controller, command.answers});
  else previous_answer->answers = command.answers;
  if (!answer_pending_) {
    if (!node_.clock().lockstep() && frame_received_) answer();
    return;
  }
  if (!node_.clock().lockstep() || all_answered()) answer();
}

bool PlantNode::all_answered() const {
  const auto answered = static_cast<std::size_t>(
      std::count_if(answers_.begin(), answers_.end(),
                    [&](const Answer& a) { return a.answers >= current_frame_; }));
  return answered >= command_in_->matched() ||
         node::monotonic_ns() - pending_since_ns_ > node::lockstep_timeout_ns;
}

void PlantNode::answer() {
  auto command = plant_.command(node_.clock().now_ns());
  ecu_out_.publish(command);
  answer_pending_ = false;
  report_notices();
}

void PlantNode::repeat_answer() {
  if (!answer_pending_) answer();
}

void PlantNode::on_gains(const erp::GainCommand& command) {
  erp::EcuParameter out;
  for (const auto& gain : erp::samples(command.gains)) {
    const auto actuator = std::find(names_.begin(), names_.end(), gain.name);
    const auto index = gain_index(gain.parameter);
    if (actuator == names_.end() || !index || !std::isfinite(gain.value)) {
      report_refused_gain(gain);
      continue;
    }
    auto& value = gains_[static_cast<std::size_t>(actuator - names_.begin())][*index];
    value.value = static_cast<float>(gain.value);
    auto sent = value;
    sent.commit = false;
    erp::append(out.values, sent);
  }
  commit_last(out);
  out.stamp_ns = node_.clock().now_ns();
  if (out.values._length) parameter_out_.publish(out);
}

/// Reports each refused gain once.
void PlantNode::report_refused_gain(const erp::GainValue& gain) {
  const std::string parameter = gain.parameter, name = gain.name;
  if (!refused_gains_.insert(name + "." + parameter).second) return;
  const bool is_number = std::isfinite(gain.value);
  node_.report(erp::Severity::warning, name, "gain_refused",
               is_number ? "there is no gain " + parameter + " of " + name
                         : parameter + " must be a number, got " + std::to_string(gain.value));
}

void PlantNode::send_gains() {
  erp::EcuParameter out;
  for (std::size_t i = 0; i < gains_.size(); ++i)
    if (plant_.waits_for_gains(i))
      for (const auto& value : gains_[i]) erp::append(out.values, value);
  out.stamp_ns = node_.clock().now_ns();
  if (out.values._length) parameter_out_.publish(out);
}

void PlantNode::report_notices() {
  for (const auto& notice : plant_.take_notices())
    node_.report(notice.severity, notice.subject, notice.code, notice.text);
}

void PlantNode::publish_owners() {
  auto owners = plant_.owners();
  owner_out_.publish(owners);
}

}  // namespace plant
