#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/plant/actuator_channel.hpp"
#include "components/plant/channel_gains.hpp"
#include "components/plant/limb_monitor.hpp"
#include "components/plant/notice.hpp"
#include "components/plant/reported_once.hpp"
#include "components/plant/zeros.hpp"
#include "interfaces/topics.hpp"

/// The robot-independent layer between controllers and any device: units, limits, arbitration by
/// priority and age of the command, safe action, re-arming. Reads no clock and no bus: time and
/// messages are arguments.
namespace plant {

/// Merges three or more notices that differ only in the actuator into one that contains their
/// number. It also names the first three, unless the notices concern all actuators; `actuators` is
/// the number of all actuators. The order is otherwise unchanged.
std::vector<Notice> merge_similar(std::vector<Notice> notices, std::size_t actuators);

class Plant {
 public:
  struct Params {
    double stale_s = 0.020;
    double device_lost_s = 0.050;
    double slack_N = 0.5;
    double take_up_m = 0.03;
    void visit(auto& v) {
      v("stale_s", stale_s,
        {xml::positive,
         "Age from which a controller's command is ignored: 10 periods of the ECUs; chosen."});
      v("device_lost_s", device_lost_s,
        {xml::positive,
         "Silence after which an ECU or the device counts as lost; that of the ECUs after the last "
         "command."});
      v("slack_N", slack_N,
        {xml::at_least_zero,
         "Tension below which a tendon is slack; at least 6 times the standard deviation of the "
         "sensor; chosen."});
      v("take_up_m", take_up_m,
        {xml::positive, "Slack that is wound up before the tendon counts as snapped; chosen."});
    }
  };

  Plant(const Params& params, const erp::Robot& robot);

  /// Converts ECU counts to SI, in the order of robot.xml. Copies stamp and sequence of the frame.
  const erp::SensorFrame& sense(const erp::EcuFrame& frame, std::int64_t now_ns);
  void receive(const erp::ActuatorCommand& command, std::int64_t now_ns);
  /// Arbitrates and converts to ECU requests; answers the last frame, without a stamp. Call at least
  /// once per frame.
  const erp::EcuCommand& command(std::int64_t now_ns);
  const erp::ActuatorOwner& owners();
  /// A controller may change gains of the actuators that it may command.
  void receive(const erp::GainCommand& command);
  /// The next proposed gains and zeros; with `load`, also all gains of the channels in state boot.
  /// Without a stamp; often empty.
  const erp::EcuParameter& gains(std::int64_t now_ns, bool load);
  /// Marks all measurements invalid if the device is silent for too long. True on this transition.
  bool check_device(std::int64_t now_ns);
  /// The notices since the last call; equal notices of several actuators are merged.
  std::vector<Notice> take_notices() {
    return merge_similar(std::exchange(notices_, {}), channels_.size());
  }

 private:
  struct Reported {
    std::string owner;
    ecu_state state = ECU_STATE_BOOT;
    TendonState tendon = TendonState::taut;
    bool slack = false;                   ///< reported once per run
    bool lost = false, degraded = false;  ///< of the actuator, of its limb
    bool stays_in_boot = false;
    std::uint32_t limited = 0, refused = 0;
  };

  void sense_channel(const erp::EcuChannelSample& counts, std::int64_t now_ns);
  void mark_lost(std::size_t actuator);
  void add_analogs(const erp::Robot& robot);
  void sense_analog(const erp::EcuAnalogSample& counts, std::int64_t now_ns);
  void set_zero(std::size_t actuator, const erp::ActuatorCommand& command, double line_m,
                std::int64_t now_ns);
  void report_unknown(const std::string& controller, const std::string& name);
  void observe_gains(std::size_t actuator, const erp::EcuChannelSample& counts,
                     std::int64_t now_ns);
  std::optional<std::size_t> index_of(std::string_view actuator) const;
  std::string refusal(const erp::GainCommand& command, const erp::GainValue& gain) const;
  void refuse(const std::string& actuator, const std::string& reason);
  void notice_changes();
  void notice_tendon(const ActuatorChannel& channel, Reported& reported);
  void notice_limb(std::size_t actuator);

  std::int64_t stale_ns_, device_lost_ns_;
  LimbMonitor limb_monitor_;
  std::vector<ActuatorChannel> channels_;
  static constexpr std::size_t ecus = 128, channels_per_ecu = 2,
                               analogs_per_ecu = 4;  ///< of the bus
  /// An analog input: a joint's sensor or an actuator's potentiometer.
  struct Analog {
    double rad_per_count;
    int joint = -1, actuator = -1;  ///< index of its sample, or −1
  };
  std::vector<Analog> analogs_;
  std::array<std::array<int, channels_per_ecu>, ecus>
      channel_at_;  ///< [ecu][channel] → index or −1
  std::array<std::array<int, analogs_per_ecu>, ecus> analog_at_;  ///< [ecu][input] → index or −1
  std::vector<ChannelGains> gains_;                               ///< one per actuator
  Zeros zeros_;
  std::vector<std::int64_t> boot_since_ns_;  ///< 0: not in state boot
  erp::EcuParameter parameters_;
  std::vector<Reported> reported_;
  erp::SensorFrame frame_;
  erp::EcuCommand command_;
  erp::ActuatorOwner owner_message_;
  std::int64_t last_frame_ns_ = 0, last_decision_ns_ = 0;
  bool device_alive_ = false;
  std::vector<Notice> notices_;
  ReportedOnce unknown_, refused_gains_;
};

}  // namespace plant
