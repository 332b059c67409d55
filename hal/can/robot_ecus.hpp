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

/// The ECUs of a whole robot as the bus sees them: what a simulator needs to stand behind it.
/// Pure: no DDS, no clock, no heap after construction. What each ECU hears and says is
/// `firmware/core/link.h`, the code of the microcontroller.
///
///   for every frame on the bus:   ecus.hear(frame)        drives the channels
///   every tick:                   ecu_tick(...) of each channel, by the owner
///                                 bus.send(ecus.report(frame))
///   in lockstep, until answered:  ecus.answered(), now and then bus.send(ecus.again())
class RobotEcus {
 public:
  /// `channels`: one for each actuator, in the order of robot.xml; lent, and must outlive this.
  /// Throws std::invalid_argument when their number differs or two actuators share a channel.
  RobotEcus(const Robot& robot, std::span<ecu_channel* const> channels);

  /// Lets the ECU a frame is addressed to hear it. Returns true when it was used.
  bool hear(const CanFrame& frame);

  /// Begins a tick and says it: the frames of every ECU, valid until the next call. The tick is
  /// given as the message that would go over DDS instead, so that both ways carry the same. An ECU
  /// none of whose channels is `fresh` says nothing. The first tick says everything (as `again`).
  std::span<const CanFrame> report(const EcuFrame& tick);

  /// The last tick once more, with all a gateway needs that has just come; valid as above.
  std::span<const CanFrame> again();

  /// One boot frame of each ECU; valid as above.
  std::span<const CanFrame> boot(frame_reset_cause cause);

  /// Every ECU that spoke in this tick has heard a command computed from it.
  bool answered() const;

  /// What one ECU counted; null when robot.xml has no such ECU.
  const ecu_link* link(int address) const;

 private:
  struct Ecu {
    ecu_link link{};
    ecu_report report{};
    bool spoke = false;
  };
  int index_of(int address) const;
  Ecu* find(int address);
  void take(const EcuFrame& tick);
  std::span<const CanFrame> say(bool whole);

  std::array<int, FRAME_ECUS> index_;  ///< of an address in `ecus_`, or -1
  std::vector<Ecu> ecus_;
  std::vector<CanFrame> frames_;
};

}  // namespace erp
