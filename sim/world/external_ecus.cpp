#include "sim/world/external_ecus.hpp"

#include <algorithm>

#include "firmware/core/ecu.h"
#include "sim/model/effects/library.hpp"

namespace sim {
namespace {

wire_fault_kind wire_kind_of(FaultKind kind) {
  if (kind == FaultKind::hang) return WIRE_FAULT_HANG;
  return kind == FaultKind::busy ? WIRE_FAULT_BUSY : WIRE_FAULT_BUS_OFF;
}

}  // namespace

ExternalEcus::ExternalEcus(const erp::Robot& nominal, const Options& options)
    : wires_(options.port, options.lines), turn_(options.lockstep ? 1 : 0) {
  const auto [robot, acting] = effects::equip(nominal);
  std::uint64_t seed = options.seed << 16;
  converters_ = std::make_unique<Converters>(robot, acting, 1, seed);
  voltage_V_.resize(converters_->channels().size());
  for (const int address : robot.ecus()) ecus_[address] = {};
}

void ExternalEcus::inject(const FaultInjection* faults) {
  faults_ = faults;
  converters_->inject(faults);
}

// ---- from the ECUs ----

bool ExternalEcus::receive() {
  wires_.receive([this](const auto& sender, wire_kind kind, const wire_reader& message) {
    process(sender, kind, message);
  });
  answer_all();
  return turn_ != 0 &&
         std::ranges::all_of(ecus_, [](const auto& entry) { return entry.second.waits_for_turn; });
}

void ExternalEcus::process(const PinWires::Peer& sender, wire_kind kind,
                           const wire_reader& message) {
  const auto ecu = ecus_.find(wire_ecu(&message));
  if ((kind != WIRE_DRIVE && kind != WIRE_SAMPLE) || ecu == ecus_.end()) return;
  ecu->second.peer = sender;
  ecu->second.steps_since_message = 0;
  if (kind == WIRE_DRIVE) return wire_unpack_drive(&message, ecu->second.duty.data());
  ecu->second.waits_for_turn = turn_ != 0 && wire_sample_turn(&message) == turn_;
  ecu->second.requested = !ecu->second.waits_for_turn;
}

void ExternalEcus::begin_turn() {
  turn_ = turn_ == 255 ? 1 : static_cast<std::uint8_t>(turn_ + 1);
  for (auto& [address, ecu] : ecus_) ecu.waits_for_turn = false, ecu.requested = true;
  answer_all();
}

int ExternalEcus::alive() const {
  return static_cast<int>(std::ranges::count_if(
      ecus_, [](const auto& entry) { return entry.second.steps_since_message < silent_steps; }));
}

// ---- the robot ----

double ExternalEcus::voltage_V(const Converters::Channel& channel) const {
  const Ecu& ecu = ecus_.at(channel.ecu);
  if (ecu.steps_since_message >= silent_steps) return 0;
  const int duty = ecu.duty[static_cast<std::size_t>(channel.number)];
  return channel.supply_V * std::clamp(duty, -ECU_DUTY_MAX, ECU_DUTY_MAX) / ECU_DUTY_MAX;
}

bool ExternalEcus::is_any_ecu_overdue() const {
  return turn_ == 0 && std::ranges::any_of(ecus_, [](const auto& entry) {
           return entry.second.steps_since_message > overdue_steps &&
                  entry.second.steps_since_message < silent_steps;
         });
}

bool ExternalEcus::step(World& world) {
  for (auto& [address, ecu] : ecus_)
    ecu.steps_since_message = std::min(ecu.steps_since_message + 1, silent_steps);
  if (is_any_ecu_overdue()) return false;
  const auto channels = converters_->channels();
  for (std::size_t k = 0; k < channels.size(); ++k) voltage_V_[k] = voltage_V(channels[k]);
  if (faults_) send_faults(world.time_s());
  converters_->pass(world, voltage_V_, step_s);
  ++steps_;
  store_readings();
  answer_all();
  return true;
}

void ExternalEcus::measure(const World& world) {
  converters_->measure(world);
  store_readings();
}

// ---- to the ECUs ----

void ExternalEcus::store_readings() {
  const auto readings_of = [this](int ecu) -> board_readings& {
    return ecus_.at(ecu).readings_by_step[static_cast<std::size_t>(steps_ % stored_steps)];
  };
  for (const Converters::Channel& c : converters_->channels())
    readings_of(c.ecu).channel[c.number] = c.inputs;
  for (const Converters::Analog& a : converters_->analogs())
    readings_of(a.ecu).analog[a.input] = a.counts;
}

void ExternalEcus::answer_all() {
  for (auto& [address, ecu] : ecus_)
    if (ecu.requested) answer(address, ecu);
}

/// Sends the readings of each period since the last sent readings. In lockstep, and after a long
/// time without messages, sends only the current readings.
void ExternalEcus::answer(int address, Ecu& ecu) {
  if (turn_ != 0 || steps_ - ecu.sent_step >= stored_steps) ecu.sent_step = steps_ - steps_per_tick;
  std::array<std::uint8_t, WIRE_MESSAGE_MAX * stored_steps / steps_per_tick> bytes;
  unsigned size = 0;
  for (std::int64_t next_step = 0; (next_step = ecu.sent_step + steps_per_tick) <= steps_;) {
    ecu.sent_step = next_step;
    board_readings& readings =
        ecu.readings_by_step[static_cast<std::size_t>(next_step % stored_steps)];
    readings.turn = turn_;
    size += wire_pack_readings(&bytes[size], static_cast<std::uint8_t>(address), &readings);
  }
  ecu.requested = size == 0;
  if (size > 0) send(ecu, std::span(bytes).first(size));
}

void ExternalEcus::send_faults(double time_s) {
  for (const FaultInjection::ProgramFault& fault : faults_->program_faults(time_s, step_s)) {
    const wire_fault message{static_cast<std::uint8_t>(wire_kind_of(fault.kind)),
                             static_cast<std::uint16_t>(fault.periods)};
    std::array<std::uint8_t, WIRE_MESSAGE_MAX> bytes;
    const unsigned size =
        wire_pack_fault(bytes.data(), static_cast<std::uint8_t>(fault.ecu), &message);
    send(ecus_.at(fault.ecu), std::span(bytes).first(size));
  }
}

/// Sends to an ECU that has connected. An ECU that connects later receives later messages.
void ExternalEcus::send(const Ecu& ecu, std::span<const std::uint8_t> bytes) {
  if (ecu.peer) wires_.send(*ecu.peer, bytes);
}

}  // namespace sim
