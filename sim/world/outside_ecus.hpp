#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/converters.hpp"
#include "sim/world/pin_wires.hpp"

/// A simulated robot whose ECUs are programs elsewhere: processes of this machine, or a
/// microcontroller in an emulator. Their converters and PWM stages are here; they are reached
/// by PinWires. An ECU asks for readings when it begins a period, and has its duties
/// applied from the next step of the physics on: the world runs in steps of 0.5 ms, so that what
/// the way costs is little beside the period.
///
/// In lockstep the world waits for all of them: each is given a reading, asks for the next when its
/// host has answered, and the last one's asking moves the world on by a period.
///
/// In real time it waits as well, for one that was heard and is late by half a period: a board has its
/// processor to itself, and what keeps a process from working here must not look like a motor
/// driven blindly. A PWM stage that hears nothing for 10 ms is off: whoever fed it has no power.
namespace sim {

class OutsideEcus {
 public:
  static constexpr int steps_a_tick = 4;
  static constexpr double step_s = 0.002 / steps_a_tick;
  static constexpr int late_steps = 3 * steps_a_tick / 2, silent_steps = 5 * steps_a_tick;

  struct Options {
    int port = 0;       ///< for datagrams
    std::string lines;  ///< serial devices
    std::uint64_t seed = 1;
    bool lockstep = false;
  };

  /// Throws as Converters and PinWires.
  OutsideEcus(const erp::Robot& robot, const Options& options);

  void suffer(const Mishaps* mishaps);
  std::vector<int> descriptors() const { return wires_.descriptors(); }
  /// Takes what the ECUs said. True: in lockstep, and all wait for the next reading.
  bool hear();
  /// Hands that out.
  void begin_turn();
  void measure(const World& world) { converters_->measure(world); }
  /// One step under the duties last heard, then a new measurement. False: the world waits.
  bool step(World& world);
  /// ECUs heard within the last 10 ms.
  int alive() const;
  std::uint64_t unreadable() const { return wires_.unreadable(); }

 private:
  struct Ecu {
    std::optional<PinWires::Peer> where;
    std::array<std::int16_t, 2> duty{};
    int silent = silent_steps;  ///< steps since it was heard
    bool asks = false;          ///< for the readings at hand
    bool waits = false;         ///< in lockstep, for the next ones
  };
  void take(const PinWires::Peer& from, wire_kind kind, const wire_reader& said);
  bool waits_for_one() const;
  double voltage_V(const Converters::Channel& channel) const;
  void answer(int ecu, const Ecu& to);
  void send_mishaps(double time_s);
  void send(const Ecu& ecu, std::span<const std::uint8_t> bytes);

  std::unique_ptr<Converters> converters_;
  PinWires wires_;
  std::uint8_t turn_;        ///< of the readings at hand; 0 in real time
  std::map<int, Ecu> ecus_;  ///< by address
  std::vector<double> voltage_V_;
  const Mishaps* mishaps_ = nullptr;
};

}  // namespace sim
