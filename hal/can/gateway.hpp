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

/// The result of a received frame.
enum class FrameResult {
  nothing,       ///< the tick is not complete yet, or the frame was not used
  tick,          ///< `frame()` is new: publish it
  tick_repeated  ///< the ECUs repeat a tick and wait for its answer: send `repeat()`
};

struct GatewayCounters {
  std::uint64_t corrupt = 0;           ///< size, check value or content wrong
  std::uint64_t lost = 0;              ///< STATUS and ANALOG frames missing in the counters
  std::uint64_t late = 0;              ///< older than a frame that was received before; dropped
  std::uint64_t repeated = 0;          ///< already received; dropped
  std::uint64_t foreign = 0;           ///< from an ECU or channel that robot.xml does not contain
  std::uint64_t unknown_channels = 0;  ///< commands and parameters for such a channel
  std::uint64_t incomplete_ticks = 0;  ///< published without a channel or input
};

struct EcuEmergency {
  std::uint8_t ecu = 0;
  frame_emergency content{};
};

/// An ECU that has sent HELLO.
struct EcuHello {
  std::uint8_t ecu = 0;
  bool named = false;  ///< robot.xml contains it
  frame_hello content{};
  /// Bit k: robot.xml uses number k, which the ECU does not have.
  std::uint8_t lacks_channels = 0, lacks_inputs = 0;
};

/// Translates between the plant's messages and the ECUs' frames. Pure: no DDS, no clock, no heap
/// after construction.
///
/// A tick is complete when every channel and joint sensor of robot.xml has been received once. It
/// is closed early when one of them is received a second time, or by `close_tick`; missing channels
/// then keep their last values, with `fresh` false. If the clocks of ECUs drift apart, one tick is
/// therefore incomplete each time one ECU overtakes another. Frames of simulated ECUs never mix two
/// ticks.
///
/// Frames of an ECU are used only after its HELLO or its boot frame has reported this version of
/// the frames; `discover` requests a HELLO.
///
/// While a channel runs, its STATUS does not contain its set-point, only whether the newest command
/// was accepted; the gateway then reports that command. The report is exact if no frames cross in
/// transit (lockstep). Otherwise it is up to a period early. Each HEALTH corrects it.
class Gateway {
 public:
  static constexpr std::size_t max_emergencies = 64, max_hellos = 256;

  /// Throws std::invalid_argument when two actuators share a channel or two sensors share an input.
  explicit Gateway(const Robot& robot);

  /// The COMMAND frames of a message, one for each ECU it addresses; valid until the next call.
  std::span<const CanFrame> commands(const EcuCommand& message);

  /// The PARAMETER frames of a message, in its order; valid until the next call.
  std::span<const CanFrame> parameters(const EcuParameter& message);

  /// The DISCOVER to all ECUs.
  std::span<const CanFrame> discover() const { return {&discover_, 1}; }

  /// The last COMMAND frames. An ECU that has already received them counts them as repeated.
  std::span<const CanFrame> repeat() const { return commands_; }

  FrameResult receive(const CanFrame& frame);

  /// Ends the tick now, complete or not; then `frame()` is new.
  void close_tick();

  /// The last completed tick. `sequence` counts ticks from 1; the caller sets `stamp_ns`.
  EcuFrame& frame() { return frame_; }

  GatewayCounters counters() const { return counters_; }

  /// Boots and faults reported since the last `clear_events`; beyond `max_emergencies` the newest
  /// are dropped.
  std::span<const EcuEmergency> emergencies() const { return emergencies_; }
  /// ECUs that sent HELLO, once for each change of its content; cleared by `clear_events`.
  std::span<const EcuHello> hellos() const { return hellos_; }
  void clear_events() { emergencies_.clear(), hellos_.clear(); }

  /// True if the ECU is in robot.xml and has reported this version.
  bool is_compatible(int ecu) const;
  /// True if the ECU has sent HELLO since its last boot.
  bool is_identified(int ecu) const;

  /// The last HEALTH page of a channel, in the order of robot.xml's actuators.
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
    bool in_use = false, version_matches = false;
    std::optional<frame_hello> hello;
    std::uint8_t counter = 0;             ///< of the newest STATUS
    std::uint8_t answers = 0, count = 0;  ///< of the newest COMMAND
    std::array<int, 2> channel{-1, -1};
    std::array<int, 4> analog{-1, -1, -1, -1};
    Counter analog_page[2];
    bool has_command = false;
    frame_command command{};
  };
  /// The ECU counters of a past tick, to find the counter that a command answers.
  struct PastTick {
    std::uint64_t sequence = 0;
    std::array<std::uint8_t, FRAME_ECUS> counter{};
  };

  void add(const Actuator& actuator);
  void add(const AnalogInput& used);
  void set_channel_command(Ecu& ecu, const EcuChannelCommand& requested);
  void number_command(Ecu& ecu, std::uint64_t answered_sequence);
  FrameResult receive_status(Ecu& ecu, const CanFrame& frame);
  FrameResult receive_analog(Ecu& ecu, const CanFrame& frame);
  FrameResult receive_health(Ecu& ecu, const CanFrame& frame);
  FrameResult receive_emergency(Ecu& ecu, const CanFrame& frame);
  FrameResult receive_hello(Ecu& ecu, const CanFrame& frame);
  void reset_counters(Ecu& ecu);
  FrameResult receive_corrupt();
  FrameResult finish(bool closed_early);
  bool is_new(Counter& counter, std::uint8_t received);
  void store(Channel& channel, EcuChannelSample& sample, const frame_status& content);
  int channel_index(const Ecu& ecu, const CanFrame& frame, frame_function first) const;

  std::array<Ecu, FRAME_ECUS> ecus_{};
  std::vector<Channel> channels_;  ///< in the order of robot.xml's actuators
  std::vector<Analog> analogs_;    ///< in the order of Robot::analog_inputs
  std::size_t missing_ = 0;        ///< channels and inputs not yet received in this tick
  EcuFrame tick_, frame_;          ///< tick being assembled; last completed tick
  std::array<PastTick, 8> past_ticks_{};
  std::vector<CanFrame> commands_, parameters_;
  CanFrame discover_{};
  std::vector<EcuEmergency> emergencies_;
  std::vector<EcuHello> hellos_;
  GatewayCounters counters_;
};

}  // namespace erp
