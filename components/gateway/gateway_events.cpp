// Events of the gateway, reported once per change, and the figures in its heartbeat.
#include "components/gateway/gateway_node.hpp"
#include "firmware/core/fault_names.h"

namespace can {
namespace {

const char* reset_text(std::uint8_t cause) {
  switch (cause) {
    case FRAME_RESET_POWER:
      return "power on";
    case FRAME_RESET_BROWN_OUT:
      return "brown-out of the supply";
    case FRAME_RESET_WATCHDOG:
      return "watchdog, the program hung";
    case FRAME_RESET_SOFTWARE:
      return "software reset";
    default:
      return "unknown";
  }
}

std::string ecu_name(int ecu) { return "ecu " + std::to_string(ecu); }

/// "channel 1", or "analog input 0, 2".
std::string list_text(const std::string& noun, unsigned bits) {
  std::string text;
  for (int k = 0; bits >> k; ++k)
    if (bits >> k & 1u) text += (text.empty() ? noun + " " : ", ") + std::to_string(k);
  return text;
}

std::string version_text(std::uint8_t version) {
  return "uses frame version " + std::to_string(version) + ", this gateway uses version " +
         std::to_string(FRAME_VERSION) +
         "; its frames are ignored; install the same release on both";
}

}  // namespace

void GatewayNode::report_events() {
  for (const auto& hello : gateway_.hellos()) report_hello(hello);
  for (const auto& emergency : gateway_.emergencies()) report_boot_or_fault(emergency);
  gateway_.clear_events();
}

void GatewayNode::report_hello(const erp::EcuHello& hello) {
  if (!hello.named)
    node_.report(erp::Severity::warning, ecu_name(hello.ecu), "foreign_ecu",
                 "is on the bus, but robot.xml has no actuator or sensor on it");
  else if (hello.content.version != FRAME_VERSION)
    node_.report(erp::Severity::fault, ecu_name(hello.ecu), "ecu_version",
                 version_text(hello.content.version));
  else if (hello.lacks_channels || hello.lacks_inputs)
    node_.report(erp::Severity::fault, ecu_name(hello.ecu), "ecu_incomplete",
                 "has no " + list_text("channel", hello.lacks_channels) +
                     (hello.lacks_channels && hello.lacks_inputs ? " and no " : "") +
                     list_text("analog input", hello.lacks_inputs) +
                     ", which robot.xml uses; correct robot.xml or equip the board");
}

void GatewayNode::report_boot_or_fault(const erp::EcuEmergency& emergency) {
  const frame_emergency& content = emergency.content;
  if (!content.boot)
    return node_.report(
        erp::Severity::fault, ecu_name(emergency.ecu), "emergency",
        "channel " + std::to_string(content.channel) + ": " + ecu_fault_name(content.fault));
  const bool by_power_on = content.reset_cause == FRAME_RESET_POWER;
  node_.report(by_power_on ? erp::Severity::info : erp::Severity::warning, ecu_name(emergency.ecu),
               "boot", std::string("the ECU has started: ") + reset_text(content.reset_cause));
  if (content.version != FRAME_VERSION)
    node_.report(erp::Severity::fault, ecu_name(emergency.ecu), "ecu_version",
                 version_text(content.version));
}

void GatewayNode::report_ecu(int ecu, erp::EcuWatch::Event event) {
  const std::string& actuator_names = actuators_on_[static_cast<std::size_t>(ecu)];
  const std::string actuators = actuator_names.empty() ? "" : " (" + actuator_names + ")";
  switch (event) {
    case erp::EcuWatch::Event::silent:
      return node_.report(erp::Severity::warning, ecu_name(ecu), "ecu_silent",
                          "no frame for 10 ms" + actuators);
    case erp::EcuWatch::Event::lost:
      return node_.report(
          erp::Severity::fault, ecu_name(ecu), "ecu_lost",
          "no frame for 50 ms" + actuators + "; check power, cable and its program");
    case erp::EcuWatch::Event::back:
      return node_.report(erp::Severity::info, ecu_name(ecu), "ecu_back",
                          "sends frames again" + actuators);
  }
}

void GatewayNode::report_unanswered() {
  for (const int ecu : ecus_)
    if (!gateway_.is_compatible(ecu))
      node_.report(erp::Severity::warning, ecu_name(ecu), "ecu_unanswered",
                   "has not answered DISCOVER for a second; check power, cable, address "
                   "and firmware version");
}

void GatewayNode::report_counters() {
  const auto now = gateway_.counters();
  const auto report = [&](std::uint64_t count, std::uint64_t before, const std::string& subject,
                          const char* problem) {
    if (count > before)
      node_.report(erp::Severity::warning, subject, problem,
                   std::to_string(count - before) + " " + problem + " more, " +
                       std::to_string(count) + " in total");
  };
  report(now.corrupt, reported_counters_.corrupt, "bus", "corrupt_frames");
  report(now.lost, reported_counters_.lost, "bus", "lost_frames");
  report(now.foreign, reported_counters_.foreign, "bus", "foreign_frames");
  report(now.incomplete_ticks, reported_counters_.incomplete_ticks, "bus", "incomplete_ticks");
  reported_counters_ = now;
  for (std::size_t k = 0; k < buses_.size(); ++k) {
    const std::uint64_t expired = buses_[k].outbox().expired() + buses_[k].outbox().dropped();
    report(expired, unsent_reported_[k], buses_[k].name(), "frames_not_sent");
    unsent_reported_[k] = expired;
    report(buses_[k].unrecorded(), unrecorded_reported_[k], buses_[k].name(),
           "frames_not_recorded");
    unrecorded_reported_[k] = buses_[k].unrecorded();
  }
  show_counters();
}

void GatewayNode::show_counters() {
  const auto& now = reported_counters_;
  node_.show("corrupt", static_cast<double>(now.corrupt));
  node_.show("lost", static_cast<double>(now.lost));
  node_.show("late", static_cast<double>(now.late));
  node_.show("foreign", static_cast<double>(now.foreign));
  node_.show("ticks_left_out", static_cast<double>(ticks_skipped_));
  node_.show("incomplete_ticks", static_cast<double>(now.incomplete_ticks));
  const std::int64_t now_ns = node::monotonic_ns();
  const double elapsed_s = 1e-9 * static_cast<double>(now_ns - last_counters_ns_);
  for (std::size_t k = 0; k < buses_.size(); ++k) show_bus(k, elapsed_s);
  last_counters_ns_ = now_ns;
}

void GatewayNode::show_bus(std::size_t k, double elapsed_s) {
  erp::BusKeeper& bus = buses_[k];
  const erp::BusCounters now = bus.counters();
  const std::uint64_t frames = now.sent + now.received;
  const auto show = [&](const char* counter, double value) {
    node_.show(bus.name() + "." + counter, value);
  };
  show("sent", static_cast<double>(now.sent));
  show("received", static_cast<double>(now.received));
  show("load", frame_time_s_[k] * static_cast<double>(frames - frames_before_[k]) / elapsed_s);
  show("not_sent", static_cast<double>(bus.outbox().expired() + bus.outbox().dropped()));
  show("replaced", static_cast<double>(bus.outbox().replaced()));
  show("errors", static_cast<double>(now.errors));
  show("overrun", static_cast<double>(now.overrun));
  show("state", static_cast<double>(now.state));
  show("restarts", bus.restarts());
  frames_before_[k] = frames;
}

}  // namespace can
