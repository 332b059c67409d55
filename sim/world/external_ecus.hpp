#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/converters.hpp"
#include "sim/world/pin_wires.hpp"

/// A simulated robot whose ECUs run as separate programs: processes of this machine, or a
/// microcontroller in an emulator. Their converters and PWM stages are here; PinWires connects
/// them. The duties of an ECU are applied from the next physics step on. The world runs in steps of
/// 0.5 ms, so that the transmission delay is small compared with the period.
///
/// An ECU requests the readings of its next period and receives them when the world has reached it.
/// If it requests them after that time, it receives the readings of every missed period. A board
/// samples at a constant rate, independently of the load of this machine. A shaft measured after
/// 2.5 ms instead of 2 ms would give a speed that is a quarter too high.
///
/// In lockstep the world waits for all ECUs. Each ECU receives a reading, and requests the next one
/// when its host has answered. The last request advances the world by a period.
///
/// In real time the world also waits for a connected ECU whose message is overdue by half a period.
/// A real board has its own processor. A delay of its process on this machine must therefore not
/// keep an outdated duty at the motor. A PWM stage without messages for 8 ms is off, because its
/// ECU has lost power. While the world waits, no ECU receives readings. The wait ends before the
/// other ECUs would count as disconnected.
namespace sim {

class ExternalEcus {
 public:
  static constexpr int steps_per_tick = 4;
  static constexpr double step_s = 0.002 / steps_per_tick;
  static constexpr int stored_steps = 16;  ///< steps whose readings are stored
  /// Steps since the last message after which an ECU is overdue, and after which it is
  /// disconnected.
  static constexpr int overdue_steps = 3 * steps_per_tick / 2, silent_steps = 4 * steps_per_tick;

  struct Options {
    int port = 0;       ///< for datagrams
    std::string lines;  ///< serial devices
    std::uint64_t seed = 1;
    bool lockstep = false;
  };

  /// Throws like Converters and PinWires.
  ExternalEcus(const erp::Robot& robot, const Options& options);

  void inject(const FaultInjection* faults);
  std::vector<int> descriptors() const { return wires_.descriptors(); }
  /// Processes the messages of the ECUs. True: in lockstep, all ECUs wait for the next readings.
  bool receive();
  /// Sends the next readings.
  void begin_turn();
  void measure(const World& world);
  /// One step with the last received duties, then a new measurement. False: the world waits.
  bool step(World& world);
  /// Number of ECUs with a message within the last 8 ms.
  int alive() const;
  std::uint64_t unreadable() const { return wires_.unreadable(); }

 private:
  struct Ecu {
    std::optional<PinWires::Peer> peer;
    std::array<std::int16_t, 2> duty{};
    int steps_since_message = silent_steps;  ///< steps since its last message
    bool requested = false;                  ///< has requested readings that are not sent yet
    bool waits_for_turn = false;             ///< in lockstep: waits for the next turn
    std::int64_t sent_step = -stored_steps;
    std::array<board_readings, stored_steps> readings_by_step = {};  ///< of the last steps
  };
  void process(const PinWires::Peer& from, wire_kind kind, const wire_reader& message);
  bool is_any_ecu_overdue() const;
  double voltage_V(const Converters::Channel& channel) const;
  void store_readings();
  void answer_all();
  void answer(int address, Ecu& ecu);
  void send_faults(double time_s);
  void send(const Ecu& ecu, std::span<const std::uint8_t> bytes);

  std::unique_ptr<Converters> converters_;
  PinWires wires_;
  std::uint8_t turn_;        ///< of the current readings; 0 in real time
  std::int64_t steps_ = 0;   ///< number of simulated steps
  std::map<int, Ecu> ecus_;  ///< by address
  std::vector<double> voltage_V_;
  const FaultInjection* faults_ = nullptr;
};

}  // namespace sim
