#include "components/plant/plant.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plant {
namespace {

constexpr double slack_sigmas =
    6;  // chosen: so that noise does not make a slack tendon appear taut
/// Longest interval over which a rate limit is applied. Chosen: after 50 ms without a command the ECUs
/// have switched off.
constexpr double max_interval_s = 0.05;

std::vector<double> rad_per_count(const erp::Robot& robot) {
  std::vector<double> scales;
  for (const auto& a : robot.actuators)
    scales.push_back(
        sim::EcuUnits(robot.motor_of(a), robot.sensors_of(a), a.spindle).shaft_rad_per_count);
  return scales;
}

TendonMonitor::Params tendon_params(const erp::SensorType& sensors, const Plant::Params& params) {
  return {std::max(params.slack_N, slack_sigmas * sensors.tension_noise_N), params.take_up_m};
}

}  // namespace

Plant::Plant(const Params& params, const erp::Robot& robot)
    : stale_ns_(std::llround(1e9 * params.stale_s)),
      device_lost_ns_(std::llround(1e9 * params.device_lost_s)),
      limb_monitor_(robot, device_lost_ns_),
      zeros_(robot, rad_per_count(robot)),
      boot_since_ns_(robot.actuators.size(), 0),
      reported_(robot.actuators.size()) {
  for (auto& ecu : channel_at_) ecu.fill(-1);
  for (auto& ecu : analog_at_) ecu.fill(-1);
  channels_.reserve(robot.actuators.size());
  for (const auto& actuator : robot.actuators) {
    channel_at_[static_cast<std::size_t>(actuator.ecu)]
               [static_cast<std::size_t>(actuator.channel)] = static_cast<int>(channels_.size());
    channels_.emplace_back(actuator, robot.motor_of(actuator), robot.sensors_of(actuator),
                           tendon_params(robot.sensors_of(actuator), params));
    gains_.emplace_back(static_cast<std::uint8_t>(actuator.ecu),
                        static_cast<std::uint8_t>(actuator.channel),
                        sim::design_parameters(robot, actuator, {}));
    erp::ActuatorSample sample{};
    erp::assign(sample.name, actuator.name);
    sample.ecu_state = static_cast<std::uint8_t>(erp::EcuState::unknown);
    erp::append(frame_.actuators, sample);
    erp::ActuatorOwnerSample owner{};
    erp::assign(owner.name, actuator.name);
    erp::append(owner_message_.actuators, owner);
    erp::append(
        command_.channels,
        erp::EcuChannelCommand{static_cast<std::uint8_t>(actuator.ecu),
                               static_cast<std::uint8_t>(actuator.channel), ECU_REQUEST_OFF, 0});
  }
  add_analogs(robot);
}

void Plant::add_analogs(const erp::Robot& robot) {
  for (const auto& sensor : robot.joint_sensors) {
    analogs_.push_back({2 * std::numbers::pi / std::exp2(sensor.bits_per_rev),
                        static_cast<int>(frame_.joints._length)});
    erp::JointSample sample{};
    erp::assign(sample.name, erp::sample_name(sensor));
    erp::append(frame_.joints, sample);
  }
  for (const auto& sensor : robot.potentiometers) {
    const auto is_measured = [&](const erp::Actuator& a) { return a.name == sensor.actuator; };
    const auto actuator = std::ranges::find_if(robot.actuators, is_measured);
    analogs_.push_back({sensor.range_rad / (std::exp2(sensor.bits) - 1), -1,
                        static_cast<int>(actuator - robot.actuators.begin())});
  }
  const auto inputs = robot.analog_inputs();
  for (std::size_t k = 0; k < inputs.size(); ++k)
    analog_at_[static_cast<std::size_t>(inputs[k].ecu)][static_cast<std::size_t>(inputs[k].input)] =
        static_cast<int>(k);
}

void Plant::sense_channel(const erp::EcuChannelSample& counts, std::int64_t now_ns) {
  if (counts.ecu >= channel_at_.size() || counts.channel >= channels_per_ecu) return;
  const int index = channel_at_[counts.ecu][counts.channel];
  if (index < 0) return;
  const auto i = static_cast<std::size_t>(index);
  ActuatorChannel& channel = channels_[i];
  auto& sample = frame_.actuators._buffer[i];
  sample.valid = 0;
  if (!counts.fresh) return;
  zeros_.observe(i, counts, now_ns);
  sample.valid = zeros_.is_known(i) ? erp::valid::all : erp::valid::without_zero;
  observe_gains(i, counts, now_ns);
  if (!reported_[i].stays_in_boot) limb_monitor_.on_sample(i, now_ns);
  const sim::EcuUnits& units = channel.units();
  channel.observe(static_cast<ecu_state>(counts.state), counts.fault, counts.encoder_counts,
                  units.tension_N(counts.tension_counts), zeros_.is_known(i), now_ns);
  sample.ecu_state = counts.state;
  sample.ecu_fault = counts.fault;
  sample.mode = static_cast<std::uint8_t>(sim::EcuUnits::mode(counts.request));
  sample.reference = units.reference(counts.request, counts.setpoint);
  sample.voltage_V = units.voltage_V(counts.duty_counts);
  sample.current_A = counts.current_counts * units.current_A_per_count;
  sample.shaft_rad = units.shaft_rad(counts.encoder_counts);
  sample.line_m = units.line_m(sample.shaft_rad);
  sample.tension_N = units.tension_N(counts.tension_counts);
}

void Plant::sense_analog(const erp::EcuAnalogSample& counts, std::int64_t now_ns) {
  if (counts.ecu >= analog_at_.size() || counts.input >= analogs_per_ecu || !counts.fresh) return;
  const int index = analog_at_[counts.ecu][counts.input];
  if (index < 0) return;
  const Analog& analog = analogs_[static_cast<std::size_t>(index)];
  const double angle_rad = counts.counts * analog.rad_per_count;
  if (analog.joint >= 0) {
    auto& sample = frame_.joints._buffer[analog.joint];
    sample.valid = erp::valid::joint_angle, sample.angle_rad = angle_rad;
    zeros_.observe_joint(static_cast<std::size_t>(analog.joint), angle_rad);
  } else {
    auto& sample = frame_.actuators._buffer[analog.actuator];
    sample.valid |= erp::valid::potentiometer, sample.potentiometer_rad = angle_rad;
    if (sample.valid & erp::valid::voltage)
      zeros_.observe_potentiometer(static_cast<std::size_t>(analog.actuator), angle_rad, now_ns);
  }
}

const erp::SensorFrame& Plant::sense(const erp::EcuFrame& frame, std::int64_t now_ns) {
  frame_.stamp_ns = frame.stamp_ns;
  frame_.sequence = frame.sequence;
  for (auto& sample : erp::samples(frame_.actuators)) sample.valid = 0;
  for (auto& sample : erp::samples(frame_.joints)) sample.valid = 0;
  for (const auto& channel : erp::samples(frame.channels)) sense_channel(channel, now_ns);
  for (const auto& analog : erp::samples(frame.analogs)) sense_analog(analog, now_ns);
  zeros_.update(now_ns);
  last_frame_ns_ = now_ns;
  device_alive_ = true;
  return frame_;
}

std::optional<std::size_t> Plant::index_of(std::string_view actuator) const {
  for (std::size_t i = 0; i < channels_.size(); ++i)
    if (channels_[i].name() == actuator) return i;
  return std::nullopt;
}

/// The emergency priority is reserved for mode off and release.
static std::int32_t allowed_priority(std::int32_t priority, std::uint8_t mode) {
  const bool is_reserved =
      mode == erp::release_mode || mode == static_cast<std::uint8_t>(erp::Mode::off);
  return is_reserved ? priority : std::min(priority, erp::emergency_priority - 1);
}

void Plant::receive(const erp::ActuatorCommand& command, std::int64_t now_ns) {
  for (const auto& reference : erp::samples(command.actuators)) {
    const auto index = index_of(reference.name);
    if (!index) {
      report_unknown(command.controller, reference.name);
      continue;
    }
    ActuatorChannel& channel = channels_[*index];
    if (reference.mode == erp::release_mode) channel.release(command.controller, command.priority);
    else if (reference.mode == erp::set_zero_mode)
      set_zero(*index, command, reference.reference, now_ns);
    else
      channel.receive(command.controller, allowed_priority(command.priority, reference.mode),
                      static_cast<erp::Mode>(reference.mode), reference.reference, now_ns,
                      stale_ns_);
  }
}

void Plant::set_zero(std::size_t actuator, const erp::ActuatorCommand& command, double line_m,
                     std::int64_t now_ns) {
  ActuatorChannel& channel = channels_[actuator];
  const std::string reason = channel.zero_refusal(command.controller, command.priority, line_m);
  if (reason.empty())
    return zeros_.set(actuator, channel.units().shaft_of_line_rad(line_m), command.controller,
                      now_ns);
  channel.refuse_gains(reason);
}

void Plant::report_unknown(const std::string& controller, const std::string& name) {
  if (!unknown_.is_new(controller + " " + name)) return;
  std::string actuator_names;
  for (const auto& channel : channels_)
    actuator_names += (actuator_names.empty() ? "" : ", ") + channel.name();
  notices_.push_back({erp::Severity::warning, "", "unknown_actuator",
                      controller + " commands \"" + name + "\"; this robot has " + actuator_names});
}

const erp::EcuCommand& Plant::command(std::int64_t now_ns) {
  const double interval_s =
      last_decision_ns_ ? 1e-9 * static_cast<double>(now_ns - last_decision_ns_) : 0;
  const double dt_s = std::clamp(interval_s, 0.0, max_interval_s);
  last_decision_ns_ = now_ns;
  limb_monitor_.update(now_ns);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (limb_monitor_.lost(i)) mark_lost(i);
    const Demand demand = channels_[i].decide(now_ns, stale_ns_, dt_s, limb_monitor_.degraded(i));
    auto& channel = command_.channels._buffer[i];
    channel.request = static_cast<std::uint8_t>(demand.request);
    channel.setpoint = demand.setpoint;
  }
  command_.answers = frame_.sequence;
  notice_changes();
  return command_;
}

void Plant::mark_lost(std::size_t actuator) {
  channels_[actuator].mark_lost();
  auto& sample = frame_.actuators._buffer[actuator];
  sample.valid = 0;
  sample.ecu_state = static_cast<std::uint8_t>(erp::EcuState::unknown);
}

bool Plant::check_device(std::int64_t now_ns) {
  if (!device_alive_ || now_ns - last_frame_ns_ <= device_lost_ns_) return false;
  device_alive_ = false;
  for (std::size_t i = 0; i < channels_.size(); ++i) mark_lost(i);
  notices_.push_back({erp::Severity::fault, "", "device_lost",
                      "no frame from the device; its ECUs switch off by themselves"});
  return true;
}

}  // namespace plant
