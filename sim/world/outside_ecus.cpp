#include "sim/world/outside_ecus.hpp"

#include <algorithm>

#include "firmware/core/ecu.h"
#include "sim/model/effects/library.hpp"

namespace sim {
namespace {

wire_mishap_kind wire_kind_of(MishapKind kind) {
  if (kind == MishapKind::hang) return WIRE_MISHAP_HANG;
  return kind == MishapKind::busy ? WIRE_MISHAP_BUSY : WIRE_MISHAP_BUS_OFF;
}

}  // namespace

OutsideEcus::OutsideEcus(const erp::Robot& nominal, const Options& options)
    : wires_(options.port, options.lines), turn_(options.lockstep ? 1 : 0) {
  const auto [robot, acting] = effects::equip(nominal);
  std::uint64_t from = options.seed << 16;
  converters_ = std::make_unique<Converters>(robot, acting, 1, from);
  voltage_V_.resize(converters_->channels().size());
  for (const int address : robot.ecus()) ecus_[address] = {};
}

void OutsideEcus::suffer(const Mishaps* mishaps) {
  mishaps_ = mishaps;
  converters_->suffer(mishaps);
}

// ---- from the ECUs ----

bool OutsideEcus::hear() {
  wires_.hear([this](const auto& from, wire_kind kind, const wire_reader& said) {
    take(from, kind, said);
  });
  answer_all();
  return turn_ != 0 && std::ranges::all_of(ecus_, [](const auto& one) { return one.second.waits; });
}

void OutsideEcus::take(const PinWires::Peer& from, wire_kind kind, const wire_reader& said) {
  const auto ecu = ecus_.find(wire_ecu(&said));
  if ((kind != WIRE_DRIVE && kind != WIRE_SAMPLE) || ecu == ecus_.end()) return;
  ecu->second.where = from;
  ecu->second.silent = 0;
  if (kind == WIRE_DRIVE) return wire_unpack_drive(&said, ecu->second.duty.data());
  ecu->second.waits = turn_ != 0 && wire_sample_turn(&said) == turn_;
  ecu->second.asks = !ecu->second.waits;
}

void OutsideEcus::begin_turn() {
  turn_ = turn_ == 255 ? 1 : static_cast<std::uint8_t>(turn_ + 1);
  for (auto& [address, ecu] : ecus_) ecu.waits = false, ecu.asks = true;
  answer_all();
}

int OutsideEcus::alive() const {
  return static_cast<int>(std::ranges::count_if(
      ecus_, [](const auto& one) { return one.second.silent < silent_steps; }));
}

// ---- the robot ----

double OutsideEcus::voltage_V(const Converters::Channel& channel) const {
  const Ecu& ecu = ecus_.at(channel.ecu);
  if (ecu.silent >= silent_steps) return 0;
  const int duty = ecu.duty[static_cast<std::size_t>(channel.number)];
  return channel.supply_V * std::clamp(duty, -ECU_DUTY_MAX, ECU_DUTY_MAX) / ECU_DUTY_MAX;
}

bool OutsideEcus::waits_for_one() const {
  return turn_ == 0 && std::ranges::any_of(ecus_, [](const auto& one) {
           return one.second.silent > late_steps && one.second.silent < silent_steps;
         });
}

bool OutsideEcus::step(World& world) {
  for (auto& [address, ecu] : ecus_) ecu.silent = std::min(ecu.silent + 1, silent_steps);
  if (waits_for_one()) return false;
  const auto channels = converters_->channels();
  for (std::size_t k = 0; k < channels.size(); ++k) voltage_V_[k] = voltage_V(channels[k]);
  if (mishaps_) send_mishaps(world.time_s());
  converters_->pass(world, voltage_V_, step_s);
  ++steps_;
  remember();
  answer_all();
  return true;
}

void OutsideEcus::measure(const World& world) {
  converters_->measure(world);
  remember();
}

// ---- to the ECUs ----

void OutsideEcus::remember() {
  const auto readings_of = [this](int ecu) -> board_readings& {
    return ecus_.at(ecu).seen[static_cast<std::size_t>(steps_ % kept_steps)];
  };
  for (const Converters::Channel& c : converters_->channels())
    readings_of(c.ecu).channel[c.number] = c.inputs;
  for (const Converters::Analog& a : converters_->analogs())
    readings_of(a.ecu).analog[a.input] = a.counts;
}

void OutsideEcus::answer_all() {
  for (auto& [address, ecu] : ecus_)
    if (ecu.asks) answer(address, ecu);
}

/// Those of each period since it was shown some. In lockstep, and for one that has been away, those
/// of now.
void OutsideEcus::answer(int address, Ecu& ecu) {
  if (turn_ != 0 || steps_ - ecu.shown_step >= kept_steps) ecu.shown_step = steps_ - steps_a_tick;
  std::array<std::uint8_t, WIRE_MESSAGE_MAX * kept_steps / steps_a_tick> bytes;
  unsigned size = 0;
  for (std::int64_t due = 0; (due = ecu.shown_step + steps_a_tick) <= steps_;) {
    ecu.shown_step = due;
    board_readings& readings = ecu.seen[static_cast<std::size_t>(due % kept_steps)];
    readings.turn = turn_;
    size += wire_pack_readings(&bytes[size], static_cast<std::uint8_t>(address), &readings);
  }
  ecu.asks = size == 0;
  if (size > 0) send(ecu, std::span(bytes).first(size));
}

void OutsideEcus::send_mishaps(double time_s) {
  for (const Mishaps::OfEcu& one : mishaps_->of_ecus(time_s, step_s)) {
    const wire_mishap said{static_cast<std::uint8_t>(wire_kind_of(one.kind)),
                           static_cast<std::uint16_t>(one.periods)};
    std::array<std::uint8_t, WIRE_MESSAGE_MAX> bytes;
    const unsigned size = wire_pack_mishap(bytes.data(), static_cast<std::uint8_t>(one.ecu), &said);
    send(ecus_.at(one.ecu), std::span(bytes).first(size));
  }
}

/// To one that has spoken; who is not there yet hears the next.
void OutsideEcus::send(const Ecu& ecu, std::span<const std::uint8_t> bytes) {
  if (ecu.where) wires_.send(*ecu.where, bytes);
}

}  // namespace sim
