#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "components/plant/arbiter.hpp"
#include "components/plant/limits.hpp"
#include "components/plant/tendon_monitor.hpp"
#include "sim/model/actuator/ecu_units.hpp"

/// One actuator: computes the next request to its ECU from the commands of controllers and the
/// reported state of the ECU.
///
///   ECU state   no owner                 owner
///   boot        off                      off (the plant sends the gains)
///   idle        off                      arm
///   armed       off                      commanded mode, if the command arrived after arming
///   running     safe action              commanded mode, rate limits of robot.xml
///     if the limb is degraded            safe action
///     if the encoder's zero is unknown   length references count as no command
///     if the tendon is slack: winds the slack up slowly, with or without an owner
///     if the tendon has snapped: off; a command of mode off by the owner resets this
///   fault, with or without an owner: clear if the host was silent; otherwise off, and clear once
///     the owner commands mode off
namespace plant {

inline constexpr std::string_view zero_unknown_reason =
    "the zero of its encoder is unknown; set it with: erp home";
inline constexpr std::string_view outranked_reason = "another controller is the owner";

/// Limits the rate of change of a reference:  r ← r + clamp(target − r, ± rate dt).
class RateLimiter {
 public:
  static constexpr double unlimited = std::numeric_limits<double>::infinity();

  void reset(double value) { value_ = value; }
  double step(double target, double rate_per_s, double dt_s) {
    const double limit = rate_per_s * dt_s;
    if (rate_per_s == unlimited || std::abs(target - value_) <= limit) return value_ = target;
    return value_ += target > value_ ? limit : -limit;
  }
  double value() const { return value_; }

 private:
  double value_ = 0;
};

/// The next request to an ECU channel.
struct Demand {
  ecu_request request = ECU_REQUEST_OFF;
  std::int32_t setpoint = 0;
};

class ActuatorChannel {
 public:
  ActuatorChannel(const erp::Actuator& actuator, const erp::MotorType& motor,
                  const erp::SensorType& sensors, const TendonMonitor::Params& watch);

  const std::string& name() const { return name_; }
  int ecu() const { return ecu_; }
  int channel() const { return channel_; }
  const sim::EcuUnits& units() const { return units_; }
  ecu_state state() const { return state_; }

  /// Receives a controller's command. The reason is empty when it was accepted unchanged.
  Checked receive(std::string_view controller, std::int32_t priority, erp::Mode mode,
                  double reference, std::int64_t now_ns, std::int64_t stale_ns);
  /// Counts refused gains, with the reason.
  void refuse_gains(std::string_view reason) { ++refused_gains_, reason_ = reason; }
  /// Why a controller may not set the zero of the encoder now; empty: it may.
  std::string zero_refusal(std::string_view controller, std::int32_t priority, double line_m) const;
  /// A controller gives up the actuator (interfaces/emergency.hpp).
  void release(std::string_view controller, std::int32_t priority) {
    arbiter_.release(controller, priority);
  }
  bool is_released() const { return arbiter_.is_released(); }
  /// True while an emergency off is latched.
  bool is_emergency_off() const { return arbiter_.is_emergency_off(); }
  /// Stores the reported state of the ECU.
  void observe(ecu_state state, std::uint8_t fault, std::int32_t encoder_counts, double tension_N,
               bool zero_known, std::int64_t now_ns);
  /// Marks the ECU as lost: its state is unknown until the next `observe`.
  void mark_lost();
  /// Computes the next request; `dt_s` since the last call. With `limb_degraded` another ECU of the
  /// limb is lost (limb_monitor.hpp), so the safe action applies.
  Demand decide(std::int64_t now_ns, std::int64_t stale_ns, double dt_s,
                bool limb_degraded = false);

  std::string_view owner() const { return arbiter_.owner(); }
  /// False while another controller of at least this priority is the owner.
  bool may_command(std::string_view controller, std::int32_t priority) const {
    return !arbiter_.outranked(controller, priority);
  }
  std::int32_t priority() const { return priority_; }
  /// The active safe action; none while the owner's commands are followed or the ECU is off.
  erp::SafeAction safe_action() const { return active_safe_action_; }
  TendonState tendon() const { return tendon_monitor_.state(); }
  std::uint32_t limited() const { return limited_; }
  std::uint32_t refused() const { return refused_; }
  std::uint32_t refused_gains() const { return refused_gains_; }
  std::string_view reason() const { return reason_; }

 private:
  Demand follow_command(const ControllerCommand& command, double dt_s);
  double rate_per_s(erp::Mode mode) const;
  double rate_limited(const ControllerCommand& command, double dt_s);
  Demand apply_safe_action();
  Demand supervise_tendon(Demand demand, std::int64_t now_ns, double dt_s);
  bool winds_until_taut(const Demand& demand) const;
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
  bool zero_known_ = false;
  std::int32_t encoder_counts_ = 0, hold_counts_ = 0;
  std::int64_t armed_ns_ = 0;
  double max_line_speed_m_per_s_, max_tension_rate_N_per_s_;
  RateLimiter rate_limiter_;
  erp::Mode rate_limited_mode_ = erp::Mode::off;  ///< mode of rate_limiter_
  bool is_approaching_ = false;
  TendonMonitor tendon_monitor_;
  double slack_N_, tension_N_ = 0, take_up_line_m_ = 0;
  bool is_taking_up_ = false;
  erp::SafeAction active_safe_action_ = erp::SafeAction::none;
  std::int32_t priority_ = 0;
  std::uint32_t limited_ = 0, refused_ = 0;
  std::uint32_t refused_gains_ = 0;
  std::string reason_;
};

}  // namespace plant
