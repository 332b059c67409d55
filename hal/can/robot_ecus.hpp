#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "firmware/core/link.h"
#include "hal/can/bus.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/topics.hpp"

namespace erp {

/// The ECU side of the bus for a whole robot, for a simulator that acts as the ECUs.
/// Pure: no DDS, no clock, no heap after construction. Each ECU receives and sends through
/// `firmware/core/link.h`, as the microcontroller does.
///
///   for every frame on the bus:   ecus.receive(frame)     commands the channels
///   every tick:                   ecu_tick(...) of each channel, by the owner
///                                 bus.send(ecus.report(frame))
///   in lockstep, until answered:  ecus.answered(), occasionally bus.send(ecus.repeat())
class RobotEcus {
 public:
  /// `channels`: one for each actuator, in the order of robot.xml; not owned, must outlive this.
  /// Throws std::invalid_argument when their number differs or two actuators share a channel.
  RobotEcus(const Robot& robot, std::span<ecu_channel* const> channels);

  /// Passes a frame to the ECU that it addresses. Returns true when it was used.
  bool receive(const CanFrame& frame);

  /// Begins a tick and packs it: the frames of every ECU, valid until the next call. `tick` is the
  /// message that is otherwise sent over DDS, so that bus and DDS carry the same data. An ECU
  /// without a `fresh` channel sends nothing. The first tick contains all frames, like `repeat`.
  std::span<const CanFrame> report(const EcuFrame& tick);

  /// The last tick again, with all frames that a newly started gateway needs; valid until the next
  /// call.
  std::span<const CanFrame> repeat();

  /// One boot frame of each ECU; valid until the next call.
  std::span<const CanFrame> boot(frame_reset_cause cause);

  /// Resets the link of one ECU; returns its boot frame, valid until the next call. Its next frames are
  /// all frames, like `repeat`.
  std::span<const CanFrame> reset(int address, frame_reset_cause cause);

  /// True if every ECU that sent in this tick has received a command computed from the tick.
  bool answered() const;

  /// The link of one ECU, with its counters; null when robot.xml has no such ECU.
  const ecu_link* link(int address) const;

 private:
  struct Ecu {
    ecu_link link{};
    ecu_report report{};
    bool sent = false;
  };
  int index_of(int address) const;
  Ecu* find(int address);
  void store_readings(const EcuFrame& tick);
  std::span<const CanFrame> pack(bool all_frames);

  std::array<int, FRAME_ECUS> index_;  ///< of an address in `ecus_`, or -1
  std::vector<Ecu> ecus_;
  std::vector<CanFrame> frames_;
};

}  // namespace erp
