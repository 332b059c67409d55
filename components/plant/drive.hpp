#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "components/plant/arbiter.hpp"
#include "components/plant/limits.hpp"
#include "components/plant/slew.hpp"
#include "components/plant/tendon_watch.hpp"
#include "sim/model/actuator/ecu_units.hpp"

/// One actuator as the plant sees it: from what controllers offer and what its ECU says, to what
/// its ECU is asked next.
///
///   ECU state   nobody drives            somebody drives
///   boot        off                      off (the plant sends the gains)
///   idle        off                      arm
///   armed       off                      its mode, once a command came after arming
///   running     the safe action          its mode, no faster than robot.xml allows
///   …           and its limb is broken   the safe action
///   …           and pulls at nothing      takes the slack up slowly; when it comes to nothing, off
///                                         until the driver says off
///   fault       clear when it was the silence of the host, otherwise off until the driver says off
namespace plant {

inline constexpr std::string_view outranked_reason = "another controller drives";

struct Demand {
  ecu_request request = ECU_REQUEST_OFF;
  std::int32_t setpoint = 0;
};

class Drive {
 public:
  Drive(const erp::Actuator& actuator, const erp::MotorType& motor, const erp::SensorType& sensors,
        const TendonWatch::Params& watch);

  const std::string& name() const { return name_; }
  int ecu() const { return ecu_; }
  int channel() const { return channel_; }
  const sim::EcuUnits& units() const { return units_; }
  ecu_state state() const { return state_; }

  /// A controller's command. The reason is empty when it was taken as it is.
  Checked accept(std::string_view controller, std::int32_t priority, erp::Mode mode,
                 double reference, std::int64_t now_ns, std::int64_t stale_ns);
  /// What the ECU reported.
  void observe(ecu_state state, std::uint8_t fault, std::int32_t encoder_counts, double tension_N,
               std::int64_t now_ns);
  /// The device fell silent: nothing is known until it speaks again.
  void lose();
  /// What to ask of the ECU now; `dt_s` since the last call. `limb_broken`: one that it works with
  /// is lost (limbs.hpp), so nobody drives.
  Demand decide(std::int64_t now_ns, std::int64_t stale_ns, double dt_s, bool limb_broken = false);

  std::string_view owner() const { return arbiter_.owner(); }
  std::int32_t priority() const { return priority_; }
  /// The safe action in force; none while a controller drives or the ECU is off.
  erp::SafeAction safe_action() const { return safe_now_; }
  Tautness tendon() const { return watch_.now(); }
  std::uint32_t limited() const { return limited_; }
  std::uint32_t refused() const { return refused_; }
  std::string_view reason() const { return reason_; }

 private:
  Demand drive(const Offer& offer, double dt_s);
  double rate_per_s(erp::Mode mode) const;
  double slewed(const Offer& offer, double dt_s);
  Demand stay_safe();
  Demand mind_the_tendon(Demand demand, std::int64_t now_ns, double dt_s);
  bool pulls(const Demand& demand) const;
  Demand take_up(double line_m, double dt_s);

  std::string name_;
  int ecu_, channel_;
  erp::SafeAction safe_action_;
  double relax_tension_N_, approach_m_per_s_;
  sim::EcuUnits units_;
  Limits limits_;
  Arbiter arbiter_;
  ecu_state state_ = ECU_STATE_BOOT;
  std::uint8_t fault_ = 0;
  std::int32_t encoder_counts_ = 0, hold_counts_ = 0;
  std::int64_t armed_ns_ = 0;
  double max_line_speed_m_per_s_, max_tension_rate_N_per_s_;
  Slew slew_;
  erp::Mode slewed_mode_ = erp::Mode::off;  ///< of slew_
  bool approaching_ = false;
  TendonWatch watch_;
  double slack_N_, tension_N_ = 0, take_up_line_m_ = 0;
  bool taking_up_ = false;
  erp::SafeAction safe_now_ = erp::SafeAction::none;
  std::int32_t priority_ = 0;
  std::uint32_t limited_ = 0, refused_ = 0;
  std::string_view reason_;
};

}  // namespace plant
