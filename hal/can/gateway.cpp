#include "hal/can/gateway.hpp"

#include <algorithm>
#include <stdexcept>

namespace erp {
namespace {

static_assert(ECU_PARAMETER_COUNT < 63, "a parameter's index has 6 bits on the bus");
constexpr std::uint8_t no_parameter = 63;
static_assert(ECU_ZERO < no_parameter);
constexpr std::uint8_t last_position = 255;  // of a PARAMETER in a set; continues at 1

/// The command as sent on the bus. An unknown request becomes a set-point that every ECU rejects.
frame_channel_command to_channel_command(const EcuChannelCommand& requested) {
  if (requested.request > ECU_REQUEST_FORCE) return {ECU_REQUEST_VOLTAGE, FRAME_SETPOINT_REFUSED};
  return {requested.request, requested.setpoint};
}

}  // namespace

// ---- construction ----

Gateway::Gateway(const Robot& robot) {
  for (std::size_t i = 0; i < ecus_.size(); ++i) ecus_[i].address = static_cast<std::uint8_t>(i);
  for (const Actuator& actuator : robot.actuators) add(actuator);
  for (const AnalogInput& input : robot.analog_inputs()) add(input);
  missing_ = channels_.size() + analogs_.size();
  assign(tick_.robot, robot.name);
  frame_ = tick_;
  commands_.reserve(FRAME_ECUS);
  parameters_.reserve(capacity_of<EcuParameterValue>);
  emergencies_.reserve(max_emergencies);
  hellos_.reserve(max_hellos);
  frame_pack_discover(&discover_, FRAME_EVERYONE);
}

void Gateway::add(const Actuator& actuator) {
  Ecu& ecu = ecus_.at(static_cast<std::size_t>(actuator.ecu));
  int& index = ecu.channel.at(static_cast<std::size_t>(actuator.channel));
  if (index >= 0)
    throw std::invalid_argument("actuator \"" + actuator.name + "\": ECU " +
                                std::to_string(actuator.ecu) + " channel " +
                                std::to_string(actuator.channel) + " is already in use");
  index = static_cast<int>(channels_.size());
  ecu.in_use = true;
  Channel& channel = channels_.emplace_back();
  channel.ecu = ecu.address;
  channel.channel = static_cast<std::uint8_t>(actuator.channel);
  EcuChannelSample sample{};
  sample.ecu = channel.ecu;
  sample.channel = channel.channel;
  sample.state = static_cast<std::uint8_t>(EcuState::unknown);
  append(tick_.channels, sample);
}

void Gateway::add(const AnalogInput& used) {
  Ecu& ecu = ecus_.at(static_cast<std::size_t>(used.ecu));
  int& index = ecu.analog.at(static_cast<std::size_t>(used.input));
  if (index >= 0)
    throw std::invalid_argument(used.reader + ": ECU " + std::to_string(used.ecu) + " input " +
                                std::to_string(used.input) + " is already in use");
  index = static_cast<int>(analogs_.size());
  ecu.in_use = true;
  analogs_.push_back({ecu.address, static_cast<std::uint8_t>(used.input), false});
  append(tick_.analogs,
         EcuAnalogSample{.ecu = ecu.address, .input = static_cast<std::uint8_t>(used.input)});
}

bool Gateway::is_compatible(int ecu) const {
  return ecu >= 0 && ecu < static_cast<int>(FRAME_ECUS) &&
         ecus_[static_cast<std::size_t>(ecu)].version_matches;
}

bool Gateway::is_identified(int ecu) const {
  return ecu >= 0 && ecu < static_cast<int>(FRAME_ECUS) &&
         ecus_[static_cast<std::size_t>(ecu)].hello.has_value();
}

// ---- frames to the ECUs ----

std::span<const CanFrame> Gateway::commands(const EcuCommand& message) {
  commands_.clear();
  for (Ecu& ecu : ecus_) ecu.has_command = false;
  for (const EcuChannelCommand& requested : samples(message.channels)) {
    const bool is_in_use = requested.ecu < FRAME_ECUS && requested.channel < 2 &&
                           ecus_[requested.ecu].channel[requested.channel] >= 0;
    if (is_in_use) set_channel_command(ecus_[requested.ecu], requested);
    else ++counters_.unknown_channels;
  }
  for (Ecu& ecu : ecus_) {
    if (!ecu.has_command) continue;
    number_command(ecu, message.answers);
    frame_pack_command(&commands_.emplace_back(), ecu.address, &ecu.command);
  }
  return commands_;
}

void Gateway::set_channel_command(Ecu& ecu, const EcuChannelCommand& requested) {
  if (!ecu.has_command) ecu.command = {{{FRAME_REQUEST_NONE, 0}, {FRAME_REQUEST_NONE, 0}}, 0, 0};
  ecu.has_command = true;
  ecu.command.channel[requested.channel] = to_channel_command(requested);
  channels_[static_cast<std::size_t>(ecu.channel[requested.channel])].sent =
      ecu.command.channel[requested.channel];
}

/// Sets the counter of the tick that the command answers, if it is still stored, and the number of
/// the command.
void Gateway::number_command(Ecu& ecu, std::uint64_t answered_sequence) {
  const PastTick& past_tick = past_ticks_[answered_sequence % past_ticks_.size()];
  const bool is_stored = past_tick.sequence == answered_sequence && answered_sequence != 0;
  if (is_stored) ecu.answers = past_tick.counter[ecu.address];
  ecu.count = static_cast<std::uint8_t>((ecu.count + 1) & 7);
  ecu.command.answers = ecu.answers;
  ecu.command.count = ecu.count;
}

std::span<const CanFrame> Gateway::parameters(const EcuParameter& message) {
  parameters_.clear();
  for (const EcuParameterValue& requested : samples(message.values)) {
    const bool is_in_use = requested.ecu < FRAME_ECUS && requested.channel < 2 &&
                           ecus_[requested.ecu].channel[requested.channel] >= 0;
    if (!is_in_use) {
      ++counters_.unknown_channels;
      continue;
    }
    Channel& channel =
        channels_[static_cast<std::size_t>(ecus_[requested.ecu].channel[requested.channel])];
    const frame_parameter content{requested.channel, std::min(requested.index, no_parameter),
                                  requested.commit, channel.next_position, requested.value};
    frame_pack_parameter(&parameters_.emplace_back(), requested.ecu, &content);
    if (requested.index == ECU_ZERO) continue;  // not part of a set
    const int next = content.position == last_position ? 1 : content.position + 1;
    channel.next_position = static_cast<std::uint8_t>(requested.commit ? 0 : next);
  }
  return parameters_;
}

// ---- ticks ----

FrameResult Gateway::finish(bool closed_early) {
  if (missing_ == 0) {
    close_tick();
    return FrameResult::tick;
  }
  return closed_early ? FrameResult::tick : FrameResult::nothing;
}

void Gateway::close_tick() {
  if (missing_ > 0) ++counters_.incomplete_ticks;
  ++tick_.sequence;
  frame_ = tick_;
  PastTick& past_tick = past_ticks_[tick_.sequence % past_ticks_.size()];
  past_tick.sequence = tick_.sequence;
  for (const Ecu& ecu : ecus_) past_tick.counter[ecu.address] = ecu.counter;
  for (EcuChannelSample& sample : samples(tick_.channels)) sample.fresh = false;
  for (EcuAnalogSample& sample : samples(tick_.analogs)) sample.fresh = false;
  for (Channel& channel : channels_) channel.fresh = false;
  for (Analog& analog : analogs_) analog.fresh = false;
  missing_ = channels_.size() + analogs_.size();
}

}  // namespace erp
