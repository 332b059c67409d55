#include "components/plant/drive.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/actuator/motor.hpp"

namespace plant {
namespace {

/// How fast slack is wound up; chosen.
constexpr double take_up_m_per_s = 0.010;

/// Faults that only say the host was silent: cleared by the host speaking again.
bool was_silence(std::uint8_t fault) {
  return fault == ECU_FAULT_COMMAND_TIMEOUT || fault == ECU_FAULT_CORRUPT ||
         fault == ECU_FAULT_BUS_OFF;
}

}  // namespace

Drive::Drive(const erp::Actuator& actuator, const erp::MotorType& motor,
             const erp::SensorType& sensors, const TendonWatch::Params& watch)
    : name_(actuator.name),
      ecu_(actuator.ecu),
      channel_(actuator.channel),
      safe_action_(actuator.safe_action),
      relax_tension_N_(actuator.relax_tension_N),
      approach_m_per_s_(0.5 * sim::top_line_speed_m_per_s(motor, actuator.spindle.radius_m)),
      units_(motor, sensors, actuator.spindle),
      limits_(actuator, motor, sensors),
      max_line_speed_m_per_s_(actuator.max_line_speed_m_per_s.value_or(Slew::free)),
      max_tension_rate_N_per_s_(actuator.max_tension_rate_N_per_s.value_or(Slew::free)),
      watch_(watch),
      slack_N_(watch.slack_N) {}

Checked Drive::accept(std::string_view controller, std::int32_t priority, erp::Mode mode,
                      double reference, std::int64_t now_ns, std::int64_t stale_ns) {
  Checked checked = limits_.check(mode, reference);
  if (checked.verdict != Verdict::refused &&
      !arbiter_.offer(controller, priority, mode, checked.reference, now_ns, stale_ns))
    checked = {Verdict::refused, 0, "too many controllers"};
  if (checked.verdict == Verdict::limited) ++limited_;
  if (checked.verdict != Verdict::refused && arbiter_.outranked(controller, priority))
    checked = {Verdict::refused, 0, outranked_reason};
  if (checked.verdict == Verdict::refused) ++refused_;
  if (!checked.reason.empty()) reason_ = checked.reason;
  return checked;
}

void Drive::observe(ecu_state state, std::uint8_t fault, std::int32_t encoder_counts,
                    double tension_N, std::int64_t now_ns) {
  if (state == ECU_STATE_ARMED && state_ != ECU_STATE_ARMED) {
    armed_ns_ = now_ns;
    approaching_ = true;
    slewed_mode_ = erp::Mode::off;
  }
  state_ = state;
  fault_ = fault;
  encoder_counts_ = encoder_counts;
  tension_N_ = tension_N;
}

void Drive::lose() {
  state_ = ECU_STATE_BOOT;
  safe_now_ = erp::SafeAction::none;
}

Demand Drive::decide(std::int64_t now_ns, std::int64_t stale_ns, double dt_s, bool limb_broken) {
  const Offer* offer = arbiter_.winner(now_ns, stale_ns);
  priority_ = offer ? offer->priority : 0;
  const bool wants_off = offer && offer->mode == erp::Mode::off;
  if (limb_broken && !wants_off) offer = nullptr;
  if (!offer) slewed_mode_ = erp::Mode::off, approaching_ = true;
  if (state_ != ECU_STATE_RUNNING || offer) safe_now_ = erp::SafeAction::none;
  if (wants_off) watch_.forget();
  if (state_ != ECU_STATE_RUNNING) watch_.rest();
  const bool snapped = watch_.now() == Tautness::snapped;
  if (watch_.now() != Tautness::slack) taking_up_ = false;
  switch (state_) {
    case ECU_STATE_BOOT:
    case ECU_STATE_COUNT:
      return {};
    case ECU_STATE_IDLE:
      return {offer && !wants_off && !snapped ? ECU_REQUEST_ARM : ECU_REQUEST_OFF, 0};
    case ECU_STATE_ARMED:
      if (!offer || wants_off || snapped) return {};
      return offer->received_ns > armed_ns_ ? drive(*offer, dt_s) : Demand{ECU_REQUEST_ARM, 0};
    case ECU_STATE_RUNNING:
      if (wants_off) return {};
      return mind_the_tendon(offer ? drive(*offer, dt_s) : stay_safe(), now_ns, dt_s);
    case ECU_STATE_FAULT:
      if (was_silence(fault_) || wants_off) return {ECU_REQUEST_CLEAR, fault_};
      return {ECU_REQUEST_OFF, 0};
  }
  return {};
}

/// After arming, and after a safe action, a length reference is approached at half the motor's top
/// speed; once reached it is followed as it comes.
double Drive::rate_per_s(erp::Mode mode) const {
  if (mode == erp::Mode::force) return max_tension_rate_N_per_s_;
  if (mode != erp::Mode::length) return Slew::free;
  return approaching_ ? std::min(approach_m_per_s_, max_line_speed_m_per_s_)
                      : max_line_speed_m_per_s_;
}

/// A mode begins where line or tension are, not where its reference is.
double Drive::slewed(const Offer& offer, double dt_s) {
  if (slewed_mode_ != offer.mode)
    slew_.start(offer.mode == erp::Mode::force ? tension_N_
                                               : units_.line_m(units_.shaft_rad(encoder_counts_)));
  slewed_mode_ = offer.mode;
  return slew_.towards(offer.reference, rate_per_s(offer.mode), dt_s);
}

Demand Drive::drive(const Offer& offer, double dt_s) {
  const double reference = slewed(offer, dt_s);
  const bool reached = reference == offer.reference;
  if (!reached && !(approaching_ && offer.mode == erp::Mode::length)) {
    ++limited_;
    reason_ = offer.mode == erp::Mode::force ? "limited to max_tension_rate_N_per_s"
                                             : "limited to max_line_speed_m_per_s";
  }
  if (reached && offer.mode == erp::Mode::length) approaching_ = false;
  return {sim::EcuUnits::request(offer.mode), units_.setpoint(offer.mode, reference)};
}

Demand Drive::stay_safe() {
  if (safe_now_ == erp::SafeAction::none) hold_counts_ = encoder_counts_;
  safe_now_ = safe_action_;
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

/// A length law stops by itself where it is told to; the others wind until something pulls back.
bool Drive::pulls(const Demand& demand) const {
  const double slack =
      demand.request == ECU_REQUEST_FORCE ? units_.setpoint(erp::Mode::force, 2 * slack_N_) : 0;
  return demand.request != ECU_REQUEST_LENGTH && demand.setpoint > slack;
}

Demand Drive::mind_the_tendon(Demand demand, std::int64_t now_ns, double dt_s) {
  const double line_m = units_.line_m(units_.shaft_rad(encoder_counts_));
  switch (watch_.see(tension_N_, line_m, pulls(demand), now_ns)) {
    case Tautness::taut:
      return demand;
    case Tautness::slack:
      return take_up(line_m, dt_s);
    case Tautness::snapped:
      break;
  }
  return {};
}

Demand Drive::take_up(double line_m, double dt_s) {
  if (!taking_up_) take_up_line_m_ = line_m;
  taking_up_ = true;
  take_up_line_m_ -= take_up_m_per_s * dt_s;
  return {ECU_REQUEST_LENGTH, units_.setpoint(erp::Mode::length, take_up_line_m_)};
}

}  // namespace plant
