#pragma once
#include <netinet/in.h>

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "firmware/board/wire.h"
#include "sim/world/converters.hpp"

/// A simulated robot whose ECUs are programs elsewhere: processes of this machine, or a
/// microcontroller in an emulator. Their converters and PWM stages are here; they meet as datagrams
/// of firmware/board/wire.h. An ECU asks for readings when it begins a period, and has its duties
/// applied from the next step of the physics on: the world runs in steps of 0.5 ms, so that what
/// the way costs is little beside the period.
///
/// A PWM stage that hears nothing for 10 ms is off: whoever fed it has no power.
namespace sim {

class OutsideEcus {
 public:
  static constexpr int steps_a_tick = 4;
  static constexpr double step_s = 0.002 / steps_a_tick;
  static constexpr int silent_steps = 5 * steps_a_tick;

  /// Listens on loopback. Throws as Converters, and std::runtime_error when the port is taken.
  OutsideEcus(const erp::Robot& robot, int port, std::uint64_t seed);
  ~OutsideEcus();
  OutsideEcus(const OutsideEcus&) = delete;
  OutsideEcus& operator=(const OutsideEcus&) = delete;

  void suffer(const Mishaps* mishaps);
  int descriptor() const { return socket_; }
  /// Takes what the ECUs said.
  void hear();
  void measure(const World& world) { converters_->measure(world); }
  /// One step under the duties last heard, then a new measurement.
  void step(World& world);
  /// ECUs heard within the last 10 ms.
  int alive() const;
  std::uint64_t unreadable() const;

 private:
  struct Ecu {
    sockaddr_in where{};
    std::array<std::int16_t, 2> duty{};
    int silent = silent_steps;  ///< steps since it was heard
  };
  void take(const sockaddr_in& from, std::span<const std::uint8_t> bytes);
  double voltage_V(const Converters::Channel& channel) const;
  void answer(int ecu, Ecu& to);
  void send_mishaps(double time_s);
  void send(const Ecu& ecu, std::span<const std::uint8_t> bytes);

  std::unique_ptr<Converters> converters_;
  int socket_;
  std::map<int, Ecu> ecus_;                                      ///< by address
  std::map<std::pair<in_addr_t, in_port_t>, wire_reader> open_;  ///< what each sender has begun
  std::vector<double> voltage_V_;
  const Mishaps* mishaps_ = nullptr;
};

}  // namespace sim
