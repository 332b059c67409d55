#include "components/plant/actuator_channel.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/actuator/motor.hpp"

namespace plant {
namespace {

/// Speed at which slack line is wound up; chosen.
constexpr double take_up_m_per_s = 0.010;

/// Faults caused by missing or corrupt host messages; cleared once messages arrive again.
bool is_timeout_fault(std::uint8_t fault) {
  return fault == ECU_FAULT_COMMAND_TIMEOUT || fault == ECU_FAULT_CORRUPT ||
         fault == ECU_FAULT_BUS_OFF;
}

}  // namespace

ActuatorChannel::ActuatorChannel(const erp::Actuator& actuator, const erp::MotorType& motor,
                                 const erp::SensorType& sensors, const TendonMonitor::Params& watch)
    : name_(actuator.name),
      ecu_(actuator.ecu),
      channel_(actuator.channel),
      safe_action_(actuator.safe_action),
      relax_tension_N_(actuator.relax_tension_N),
      approach_m_per_s_(0.5 * sim::top_line_speed_m_per_s(motor, actuator.spindle.radius_m)),
      units_(motor, sensors, actuator.spindle),
      limits_(actuator, motor, sensors),
      max_line_speed_m_per_s_(actuator.max_line_speed_m_per_s.value_or(RateLimiter::unlimited)),
      max_tension_rate_N_per_s_(actuator.max_tension_rate_N_per_s.value_or(RateLimiter::unlimited)),
      tendon_monitor_(watch),
      slack_N_(watch.slack_N) {
  reason_.reserve(96);  // of actuator_owner; no allocation while controlling
}

Checked ActuatorChannel::receive(std::string_view controller, std::int32_t priority, erp::Mode mode,
                                 double reference, std::int64_t now_ns, std::int64_t stale_ns) {
  Checked checked = limits_.check(mode, reference);
  if (mode == erp::Mode::length && !zero_known_)
    checked = {Verdict::refused, 0, zero_unknown_reason};
  if (checked.verdict != Verdict::refused &&
      !arbiter_.update(controller, priority, mode, checked.reference, now_ns, stale_ns))
    checked = {
        Verdict::refused, 0,
        arbiter_.is_emergency_off() ? "the emergency off is latched" : "too many controllers"};
  if (checked.verdict == Verdict::limited) ++limited_;
  if (checked.verdict != Verdict::refused && arbiter_.outranked(controller, priority))
    checked = {Verdict::refused, 0, outranked_reason};
  if (checked.verdict == Verdict::refused) ++refused_;
  if (!checked.reason.empty()) reason_ = checked.reason;
  return checked;
}

void ActuatorChannel::observe(ecu_state state, std::uint8_t fault, std::int32_t encoder_counts,
                              double tension_N, bool zero_known, std::int64_t now_ns) {
  if (state == ECU_STATE_ARMED && state_ != ECU_STATE_ARMED) {
    armed_ns_ = now_ns;
    is_approaching_ = true;
    rate_limited_mode_ = erp::Mode::off;
  }
  if (zero_known != zero_known_) {  // the counts jump
    tendon_monitor_.reset_unless_snapped();
    rate_limited_mode_ = erp::Mode::off, is_approaching_ = true, is_taking_up_ = false;
    active_safe_action_ = erp::SafeAction::none;
  }
  zero_known_ = zero_known;
  state_ = state;
  fault_ = fault;
  encoder_counts_ = encoder_counts;
  tension_N_ = tension_N;
}

std::string ActuatorChannel::zero_refusal(std::string_view controller, std::int32_t priority,
                                          double line_m) const {
  if (!may_command(controller, priority))
    return std::string(owner()) + " is the owner; refused the zero of " + std::string(controller);
  if (!(std::abs(line_m) <= Limits::max_line_m)) return "the line is out of range";
  if (state_ == ECU_STATE_BOOT) return "its ECU is in state boot; set the zero again";
  return "";
}

void ActuatorChannel::mark_lost() {
  state_ = ECU_STATE_BOOT;
  active_safe_action_ = erp::SafeAction::none;
}

Demand ActuatorChannel::decide(std::int64_t now_ns, std::int64_t stale_ns, double dt_s,
                               bool limb_degraded) {
  const ControllerCommand* command = arbiter_.winner(now_ns, stale_ns);
  priority_ = command ? command->priority : 0;
  const bool off_commanded = command && command->mode == erp::Mode::off;
  const bool needs_zero = command && command->mode == erp::Mode::length && !zero_known_;
  if ((limb_degraded && !off_commanded) || needs_zero) command = nullptr;
  if (!command) rate_limited_mode_ = erp::Mode::off, is_approaching_ = true;
  if (state_ != ECU_STATE_RUNNING || command) active_safe_action_ = erp::SafeAction::none;
  if (off_commanded) tendon_monitor_.reset();
  if (state_ != ECU_STATE_RUNNING) tendon_monitor_.reset_unless_snapped();
  const bool snapped = tendon_monitor_.state() == TendonState::snapped;
  if (tendon_monitor_.state() != TendonState::slack) is_taking_up_ = false;
  switch (state_) {
    case ECU_STATE_BOOT:
    case ECU_STATE_COUNT:
      return {};
    case ECU_STATE_IDLE:
      return {command && !off_commanded && !snapped ? ECU_REQUEST_ARM : ECU_REQUEST_OFF, 0};
    case ECU_STATE_ARMED:
      if (!command || off_commanded || snapped) return {};
      return command->received_ns > armed_ns_ ? follow_command(*command, dt_s)
                                              : Demand{ECU_REQUEST_ARM, 0};
    case ECU_STATE_RUNNING:
      if (off_commanded) return {};
      return supervise_tendon(command ? follow_command(*command, dt_s) : apply_safe_action(),
                              now_ns, dt_s);
    case ECU_STATE_FAULT:
      if (is_timeout_fault(fault_) || off_commanded) return {ECU_REQUEST_CLEAR, fault_};
      return {ECU_REQUEST_OFF, 0};
  }
  return {};
}

/// After arming, and after a safe action, a length reference is approached at half the motor's top
/// speed. Once it is reached, only max_line_speed_m_per_s limits it.
double ActuatorChannel::rate_per_s(erp::Mode mode) const {
  if (mode == erp::Mode::force) return max_tension_rate_N_per_s_;
  if (mode != erp::Mode::length) return RateLimiter::unlimited;
  return is_approaching_ ? std::min(approach_m_per_s_, max_line_speed_m_per_s_)
                         : max_line_speed_m_per_s_;
}

/// A new mode starts from the measured line length or tension.
double ActuatorChannel::rate_limited(const ControllerCommand& command, double dt_s) {
  if (rate_limited_mode_ != command.mode)
    rate_limiter_.reset(command.mode == erp::Mode::force
                            ? tension_N_
                            : units_.line_m(units_.shaft_rad(encoder_counts_)));
  rate_limited_mode_ = command.mode;
  return rate_limiter_.step(command.reference, rate_per_s(command.mode), dt_s);
}

Demand ActuatorChannel::follow_command(const ControllerCommand& command, double dt_s) {
  const double reference = rate_limited(command, dt_s);
  const bool reached = reference == command.reference;
  if (!reached && !(is_approaching_ && command.mode == erp::Mode::length)) {
    ++limited_;
    reason_ = command.mode == erp::Mode::force ? "limited to max_tension_rate_N_per_s"
                                               : "limited to max_line_speed_m_per_s";
  }
  if (reached && command.mode == erp::Mode::length) is_approaching_ = false;
  return {sim::EcuUnits::request(command.mode), units_.setpoint(command.mode, reference)};
}

Demand ActuatorChannel::apply_safe_action() {
  if (active_safe_action_ == erp::SafeAction::none) hold_counts_ = encoder_counts_;
  active_safe_action_ = safe_action_;
  switch (safe_action_) {
    case erp::SafeAction::hold:
      return {ECU_REQUEST_LENGTH, hold_counts_};
    case erp::SafeAction::relax:
      return {ECU_REQUEST_FORCE, units_.setpoint(erp::Mode::force, relax_tension_N_)};
    case erp::SafeAction::damp:
    case erp::SafeAction::none:
      break;
  }
  return {ECU_REQUEST_VOLTAGE, 0};
}

/// A length law stops at its reference; the other laws wind until the tendon pulls back.
bool ActuatorChannel::winds_until_taut(const Demand& demand) const {
  const double slack_setpoint =
      demand.request == ECU_REQUEST_FORCE ? units_.setpoint(erp::Mode::force, 2 * slack_N_) : 0;
  return demand.request != ECU_REQUEST_LENGTH && demand.setpoint > slack_setpoint;
}

Demand ActuatorChannel::supervise_tendon(Demand demand, std::int64_t now_ns, double dt_s) {
  const double line_m = units_.line_m(units_.shaft_rad(encoder_counts_));
  switch (tendon_monitor_.update(tension_N_, line_m, winds_until_taut(demand), now_ns)) {
    case TendonState::taut:
      return demand;
    case TendonState::slack:
      return take_up(line_m, dt_s);
    case TendonState::snapped:
      break;
  }
  return {};
}

Demand ActuatorChannel::take_up(double line_m, double dt_s) {
  if (!is_taking_up_) take_up_line_m_ = line_m;
  is_taking_up_ = true;
  take_up_line_m_ -= take_up_m_per_s * dt_s;
  return {ECU_REQUEST_LENGTH, units_.setpoint(erp::Mode::length, take_up_line_m_)};
}

}  // namespace plant
