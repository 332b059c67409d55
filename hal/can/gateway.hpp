#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/can/bus.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/topics.hpp"

namespace erp {

/// What a heard frame has led to.
enum class Heard {
  nothing,       ///< the tick is not whole yet, or the frame was of no use
  tick,          ///< `frame()` is new: publish it
  tick_repeated  ///< the ECUs say a tick again, waiting for its answer: send `again()`
};

struct GatewayCounters {
  std::uint64_t corrupt = 0;           ///< size, check value or content wrong
  std::uint64_t lost = 0;              ///< STATUS and ANALOG frames missing in the counters
  std::uint64_t late = 0;              ///< older than one already heard; dropped
  std::uint64_t repeated = 0;          ///< heard before; dropped
  std::uint64_t foreign = 0;           ///< of an ECU or channel that robot.xml does not name
  std::uint64_t unknown_channels = 0;  ///< commands and parameters for such a channel
  std::uint64_t incomplete_ticks = 0;  ///< published with a channel or input missing
};

struct EcuEmergency {
  std::uint8_t ecu = 0;
  frame_emergency said{};
};

/// An ECU that has said what it is.
struct EcuHello {
  std::uint8_t ecu = 0;
  bool named = false;  ///< by robot.xml
  frame_hello said{};
  std::uint8_t lacks_channels = 0, lacks_inputs = 0;  ///< bit k: robot.xml uses it, it has none
};

/// Translates between the plant's messages and the ECUs' frames. Pure: no DDS, no clock, no heap
/// after construction.
///
/// Ticks. A tick is whole when every channel and joint sensor of robot.xml was heard once. It is
/// closed early when one of them is heard a second time, or by `close_tick`; then what is missing
/// carries its last values and `fresh` false. So ECUs whose clocks drift apart cost one incomplete
/// tick each time one overtakes another, and frames of simulated ECUs never mix two ticks.
///
/// An ECU is listened to once its HELLO, or its boot, has said that it speaks this version of the
/// frames; `discover` asks for that.
///
/// What a channel follows is not in its STATUS while it runs, only whether the newest command was
/// accepted: the gateway fills in that command. It is exact when frames do not cross on the way
/// (lockstep), up to a period early when they do, and corrected by each HEALTH.
class Gateway {
 public:
  static constexpr std::size_t emergencies_kept = 64, hellos_kept = 256;

  /// Throws std::invalid_argument when two actuators share a channel or two sensors an input.
  explicit Gateway(const Robot& robot);

  /// The COMMAND frames of a message, one for each ECU it speaks to; valid until the next call.
  std::span<const CanFrame> commands(const EcuCommand& message);

  /// The PARAMETER frames of a message, in its order; valid until the next call.
  std::span<const CanFrame> parameters(const EcuParameter& message);

  /// The DISCOVER that every ECU answers.
  std::span<const CanFrame> discover() const { return {&discover_, 1}; }

  /// The COMMAND frames last made. An ECU that has heard them takes them for repeated.
  std::span<const CanFrame> again() const { return commands_; }

  Heard hear(const CanFrame& frame);

  /// Ends the tick now, whole or not; then `frame()` is new.
  void close_tick();

  /// The tick last ended. `sequence` counts ticks from 1; `stamp_ns` is the caller's to fill in.
  EcuFrame& frame() { return frame_; }

  GatewayCounters counters() const { return counters_; }

  /// Boots and faults said since the last `clear_emergencies`; beyond `emergencies_kept` the
  /// newest are dropped.
  std::span<const EcuEmergency> emergencies() const { return emergencies_; }
  /// Every ECU that said what it is, once each time it changes; kept and cleared with those.
  std::span<const EcuHello> hellos() const { return hellos_; }
  void clear_news() { emergencies_.clear(), hellos_.clear(); }

  /// Whether an ECU of robot.xml has said that it speaks this version; false for any other.
  bool understands(int ecu) const;
  /// Whether it has said what it is since it last booted.
  bool introduced(int ecu) const;

  /// What an ECU last said of itself about a channel, in the order of robot.xml's actuators.
  const frame_health& position_page(std::size_t actuator) const {
    return channels_[actuator].page[0];
  }
  const frame_health& followed_page(std::size_t actuator) const {
    return channels_[actuator].page[1];
  }

 private:
  struct Counter {
    bool known = false;
    std::uint8_t last = 0;
  };
  struct Channel {
    std::uint8_t ecu = 0, channel = 0;
    Counter counter;
    bool encoder_known = false, fresh = false;
    frame_channel_command sent{}, followed{};
    std::uint8_t next_position = 0;  ///< of a PARAMETER
    frame_health page[2]{};
  };
  struct Analog {
    std::uint8_t ecu = 0, input = 0;
    bool fresh = false;
  };
  struct Ecu {
    std::uint8_t address = 0;
    bool in_use = false, speaks_ours = false;
    std::optional<frame_hello> hello;
    std::uint8_t counter = 0;             ///< of the newest STATUS
    std::uint8_t answers = 0, count = 0;  ///< of the newest COMMAND
    std::array<int, 2> channel{-1, -1};
    std::array<int, 4> analog{-1, -1, -1, -1};
    Counter analog_page[2];
    bool has_command = false;
    frame_command command{};
  };
  /// Which counters of the ECUs a tick was made of, to tell what a command answers.
  struct Past {
    std::uint64_t sequence = 0;
    std::array<std::uint8_t, FRAME_ECUS> counter{};
  };

  void add(const Actuator& actuator);
  void add(const AnalogInput& used);
  void fill_in(Ecu& ecu, const EcuChannelCommand& asked);
  void number(Ecu& ecu, std::uint64_t answered_sequence);
  Heard hear_status(Ecu& ecu, const CanFrame& frame);
  Heard hear_analog(Ecu& ecu, const CanFrame& frame);
  Heard hear_health(Ecu& ecu, const CanFrame& frame);
  Heard hear_emergency(Ecu& ecu, const CanFrame& frame);
  Heard hear_hello(Ecu& ecu, const CanFrame& frame);
  void forget(Ecu& ecu);
  Heard hear_corrupt();
  Heard finish(bool closed_early);
  bool is_new(Counter& counter, std::uint8_t heard);
  void store(Channel& channel, EcuChannelSample& sample, const frame_status& said);
  int channel_index(const Ecu& ecu, const CanFrame& frame, frame_function first) const;

  std::array<Ecu, FRAME_ECUS> ecus_{};
  std::vector<Channel> channels_;  ///< in the order of robot.xml's actuators
  std::vector<Analog> analogs_;    ///< in the order of Robot::analog_inputs
  std::size_t missing_ = 0;        ///< channels and inputs not yet heard in this tick
  EcuFrame tick_, frame_;          ///< being assembled; last ended
  std::array<Past, 8> past_{};
  std::vector<CanFrame> commands_, parameters_;
  CanFrame discover_{};
  std::vector<EcuEmergency> emergencies_;
  std::vector<EcuHello> hellos_;
  GatewayCounters counters_;
};

}  // namespace erp
