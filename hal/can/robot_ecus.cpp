#include "hal/can/robot_ecus.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace erp {
namespace {

/// The channels and inputs of one ECU, from robot.xml.
struct Wiring {
  std::array<ecu_channel*, 2> channel{};
  unsigned analog_inputs = 0;
};

std::map<int, Wiring> wiring_of(const Robot& robot, std::span<ecu_channel* const> channels) {
  std::map<int, Wiring> ecus;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const Actuator& actuator = robot.actuators[i];
    auto& slot = ecus[actuator.ecu].channel.at(static_cast<std::size_t>(actuator.channel));
    if (slot)
      throw std::invalid_argument("actuator \"" + actuator.name + "\": ECU " +
                                  std::to_string(actuator.ecu) + " channel " +
                                  std::to_string(actuator.channel) + " is already in use");
    slot = channels[i];
  }
  for (const AnalogInput& used : robot.analog_inputs())
    ecus[used.ecu].analog_inputs |= 1u << used.input;
  return ecus;
}

ecu_reading reading_of(const EcuChannelSample& sample) {
  ecu_reading reading{};
  reading.state = static_cast<ecu_state>(sample.state);
  reading.fault = static_cast<ecu_fault>(sample.fault);
  reading.request = static_cast<ecu_request>(sample.request);
  reading.setpoint = sample.setpoint;
  reading.inputs = {sample.encoder_counts, sample.current_counts, sample.tension_counts};
  reading.duty = sample.duty_counts;
  return reading;
}

}  // namespace

RobotEcus::RobotEcus(const Robot& robot, std::span<ecu_channel* const> channels) {
  if (channels.size() != robot.actuators.size())
    throw std::invalid_argument("robot \"" + robot.name + "\" has " +
                                std::to_string(robot.actuators.size()) + " actuators, got " +
                                std::to_string(channels.size()) + " channels");
  index_.fill(-1);
  for (const auto& [address, wiring] : wiring_of(robot, channels)) {
    index_.at(static_cast<std::size_t>(address)) = static_cast<int>(ecus_.size());
    ecu_link_init(&ecus_.emplace_back().link, static_cast<std::uint8_t>(address), wiring.channel[0],
                  wiring.channel[1], static_cast<std::uint8_t>(wiring.analog_inputs));
  }
  frames_.reserve(ecus_.size() * ECU_LINK_FRAMES_MAX);
}

int RobotEcus::index_of(int address) const {
  return address >= 0 && address < static_cast<int>(FRAME_ECUS)
             ? index_[static_cast<std::size_t>(address)]
             : -1;
}

RobotEcus::Ecu* RobotEcus::find(int address) {
  const int index = index_of(address);
  return index < 0 ? nullptr : &ecus_[static_cast<std::size_t>(index)];
}

const ecu_link* RobotEcus::link(int address) const {
  const int index = index_of(address);
  return index < 0 ? nullptr : &ecus_[static_cast<std::size_t>(index)].link;
}

bool RobotEcus::receive(const CanFrame& frame) {
  if (frame_ecu_of(&frame) == FRAME_EVERYONE) {
    for (Ecu& ecu : ecus_) ecu_link_receive(&ecu.link, &frame);
    return true;
  }
  Ecu* ecu = find(frame_ecu_of(&frame));
  return ecu && ecu_link_receive(&ecu->link, &frame);
}

std::span<const CanFrame> RobotEcus::report(const EcuFrame& tick) {
  for (Ecu& ecu : ecus_) ecu_link_tick(&ecu.link);
  store_readings(tick);
  return pack(ecus_.empty() || ecus_.front().link.tick == 1);
}

void RobotEcus::store_readings(const EcuFrame& tick) {
  for (Ecu& ecu : ecus_) ecu.sent = !ecu.link.channel[0] && !ecu.link.channel[1];
  for (const EcuChannelSample& sample : samples(tick.channels)) {
    Ecu* ecu = find(sample.ecu);
    if (!ecu || sample.channel > 1) continue;
    ecu->report.channel[sample.channel] = reading_of(sample);
    ecu->sent = ecu->sent || sample.fresh;
  }
  for (const EcuAnalogSample& sample : samples(tick.analogs))
    if (Ecu* ecu = find(sample.ecu); ecu && sample.input < ECU_ANALOG_INPUTS)
      ecu->report.analog_counts[sample.input] = sample.counts;
}

std::span<const CanFrame> RobotEcus::repeat() { return pack(true); }

std::span<const CanFrame> RobotEcus::pack(bool all_frames) {
  frames_.clear();
  std::array<CanFrame, ECU_LINK_FRAMES_MAX> content;
  for (Ecu& ecu : ecus_) {
    if (!ecu.sent) continue;
    const unsigned count = ecu_link_pack(&ecu.link, &ecu.report, all_frames, content.data());
    frames_.insert(frames_.end(), content.begin(), content.begin() + count);
  }
  return frames_;
}

std::span<const CanFrame> RobotEcus::boot(frame_reset_cause cause) {
  frames_.clear();
  for (Ecu& ecu : ecus_) ecu_link_pack_boot(&ecu.link, cause, &frames_.emplace_back());
  return frames_;
}

std::span<const CanFrame> RobotEcus::reset(int address, frame_reset_cause cause) {
  frames_.clear();
  Ecu* ecu = find(address);
  if (!ecu) return frames_;
  const ecu_link last = ecu->link;
  ecu_link_init(&ecu->link, last.ecu, last.channel[0], last.channel[1], last.analog_inputs);
  ecu->link.serial = last.serial;
  ecu->link.hello_requested = true;
  ecu_link_pack_boot(&ecu->link, cause, &frames_.emplace_back());
  return frames_;
}

bool RobotEcus::answered() const {
  return std::all_of(ecus_.begin(), ecus_.end(), [](const Ecu& ecu) {
    const bool commanded = ecu.link.channel[0] || ecu.link.channel[1];
    return !commanded || !ecu.sent || ecu.link.answered;
  });
}

}  // namespace erp
