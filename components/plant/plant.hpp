#pragma once
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "components/plant/drive.hpp"
#include "components/plant/limbs.hpp"
#include "components/plant/notice.hpp"
#include "interfaces/topics.hpp"

/// The robot-independent layer between controllers and any device: units, limits, arbitration by
/// priority and freshness, the safe action, re-arming. Pure: time comes in, messages come out.
namespace plant {

class Plant {
 public:
  struct Params {
    double stale_s = 0.020;        ///< a command older than this no longer drives
    double device_lost_s = 0.050;  ///< without a word of it for so long, an ECU is lost; or all
    double slack_N = 0.5;     ///< a tendon below it is slack; at least what its sensor can tell
    double take_up_m = 0.03;  ///< slack that may be wound up; more, and it has snapped
    void visit(auto& v) {
      v("stale_s", stale_s, xml::positive);
      v("device_lost_s", device_lost_s, xml::positive);
      v("slack_N", slack_N, xml::at_least_zero);
      v("take_up_m", take_up_m, xml::positive);
    }
  };

  Plant(const Params& params, const erp::Robot& robot);

  /// ECU counts → SI, in the order of robot.xml. Stamp and sequence are the frame's.
  const erp::SensorFrame& sense(const erp::EcuFrame& frame, std::int64_t now_ns);
  void accept(const erp::ActuatorCommand& command, std::int64_t now_ns);
  /// Arbitration → ECU terms; answers the last frame. Call once a frame or more often.
  const erp::EcuCommand& command(std::int64_t now_ns);
  const erp::ActuatorOwner& owners();
  /// Bits: actuators whose ECU channel waits for its gains (state boot, and heard).
  bool waits_for_gains(std::size_t actuator) const { return boots_[actuator]; }
  /// Forgets what the device said, if it has been silent for too long. True when it just happened.
  bool check_device(std::int64_t now_ns);
  /// What happened since the last call, what befell many actuators alike as one.
  std::vector<Notice> take_notices() {
    return together(std::exchange(notices_, {}), drives_.size());
  }

 private:
  struct Said {
    std::string owner;
    ecu_state state = ECU_STATE_BOOT;
    Tautness tendon = Tautness::taut;
    bool slack = false;                 ///< was said: once is enough
    bool lost = false, broken = false;  ///< it, its limb
    std::uint32_t limited = 0, refused = 0;
  };

  void sense_channel(const erp::EcuChannelSample& channel, std::int64_t now_ns);
  void lose(std::size_t actuator);
  void add_analogs(const erp::Robot& robot);
  void sense_analog(const erp::EcuAnalogSample& said);
  void say_unknown(const std::string& controller, const std::string& name);
  void notice_changes();
  void notice_tendon(const Drive& drive, Said& said);
  void notice_limb(std::size_t actuator);

  std::int64_t stale_ns_, device_lost_ns_;
  Limbs limbs_;
  std::vector<Drive> drives_;
  /// An analog input: a joint's sensor or an actuator's potentiometer.
  struct Analog {
    double rad_per_count;
    int joint = -1, actuator = -1;  ///< index of its sample, or −1
  };
  std::vector<Analog> analogs_;
  std::array<std::array<int, 2>, 128> drive_at_;   ///< [ecu][channel] → index or −1
  std::array<std::array<int, 4>, 128> analog_at_;  ///< [ecu][input] → index or −1
  std::vector<bool> boots_;
  std::vector<Said> said_;
  erp::SensorFrame frame_;
  erp::EcuCommand command_;
  erp::ActuatorOwner owners_;
  std::int64_t last_frame_ns_ = 0, last_decision_ns_ = 0;
  bool device_heard_ = false;
  std::vector<Notice> notices_;
  std::set<std::string> unknown_said_;  ///< controller and actuator: said once
};

}  // namespace plant
