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
/// by PinWires. The duties of an ECU are applied from the next step of the physics on: the world
/// runs in steps of 0.5 ms, so that what the way costs is little beside the period.
///
/// An ECU asks for the readings of its next period, and is given them when the world is there. One
/// that asks late gets those of every period it missed: a board samples evenly whatever else this
/// machine does, and a shaft seen after 2.5 ms instead of 2 would turn a quarter too fast.
///
/// In lockstep the world waits for all of them: each is given a reading, asks for the next when its
/// host has answered, and the last one's asking moves the world on by a period.
///
/// In real time it waits as well, for one that was heard and is late by half a period: a board has
/// its processor to itself, and what keeps a process from working here must not look like a motor
/// driven blindly. A PWM stage that hears nothing for 8 ms is off: whoever fed it has no power. While
/// the world waits nobody is given readings, so it ends before the other ECUs would look silent.
namespace sim {

class OutsideEcus {
 public:
  static constexpr int steps_a_tick = 4;
  static constexpr double step_s = 0.002 / steps_a_tick;
  static constexpr int kept_steps = 16;  ///< whose readings are known
  static constexpr int late_steps = 3 * steps_a_tick / 2, silent_steps = 4 * steps_a_tick;

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
  void measure(const World& world);
  /// One step under the duties last heard, then a new measurement. False: the world waits.
  bool step(World& world);
  /// ECUs heard within the last 8 ms.
  int alive() const;
  std::uint64_t unreadable() const { return wires_.unreadable(); }

 private:
  struct Ecu {
    std::optional<PinWires::Peer> where;
    std::array<std::int16_t, 2> duty{};
    int silent = silent_steps;  ///< steps since it was heard
    bool asks = false;          ///< for the readings that follow those it was shown
    bool waits = false;         ///< in lockstep, for the next turn
    std::int64_t shown_step = -kept_steps;
    std::array<board_readings, kept_steps> seen = {};  ///< of the last steps
  };
  void take(const PinWires::Peer& from, wire_kind kind, const wire_reader& said);
  bool waits_for_one() const;
  double voltage_V(const Converters::Channel& channel) const;
  void remember();
  void answer_all();
  void answer(int address, Ecu& ecu);
  void send_mishaps(double time_s);
  void send(const Ecu& ecu, std::span<const std::uint8_t> bytes);

  std::unique_ptr<Converters> converters_;
  PinWires wires_;
  std::uint8_t turn_;        ///< of the readings at hand; 0 in real time
  std::int64_t steps_ = 0;   ///< made by the world
  std::map<int, Ecu> ecus_;  ///< by address
  std::vector<double> voltage_V_;
  const Mishaps* mishaps_ = nullptr;
};

}  // namespace sim
