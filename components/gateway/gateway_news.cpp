// What the gateway says, once a change, and the figures in its heartbeat.
#include "firmware/core/fault_names.h"
#include "components/gateway/gateway_node.hpp"

namespace can {
namespace {

const char* reset_words(std::uint8_t cause) {
  switch (cause) {
    case FRAME_RESET_POWER:
      return "power on";
    case FRAME_RESET_BROWN_OUT:
      return "the supply broke down";
    case FRAME_RESET_WATCHDOG:
      return "its watchdog: the program hung";
    case FRAME_RESET_SOFTWARE:
      return "restarted by software";
    default:
      return "unknown";
  }
}

std::string ecu_name(int ecu) { return "ecu " + std::to_string(ecu); }

/// "channel 1", or "analog input 0, 2".
std::string listed(const std::string& what, unsigned bits) {
  std::string text;
  for (int k = 0; bits >> k; ++k)
    if (bits >> k & 1u) text += (text.empty() ? what + " " : ", ") + std::to_string(k);
  return text;
}

std::string version_words(std::uint8_t version) {
  return "speaks version " + std::to_string(version) + " of the frames, this gateway " +
         std::to_string(FRAME_VERSION) + ": it is not listened to; bring both to one release";
}

}  // namespace

void GatewayNode::say_news() {
  for (const auto& hello : gateway_.hellos()) say_hello(hello);
  for (const auto& emergency : gateway_.emergencies()) say_boot_or_fault(emergency);
  gateway_.clear_news();
}

void GatewayNode::say_hello(const erp::EcuHello& hello) {
  if (!hello.named)
    node_.report(erp::Severity::warning, ecu_name(hello.ecu), "foreign_ecu",
                 "is on the bus; robot.xml names no actuator or sensor on it");
  else if (hello.said.version != FRAME_VERSION)
    node_.report(erp::Severity::fault, ecu_name(hello.ecu), "ecu_version",
                 version_words(hello.said.version));
  else if (hello.lacks_channels || hello.lacks_inputs)
    node_.report(erp::Severity::fault, ecu_name(hello.ecu), "ecu_lacks",
                 "has no " + listed("channel", hello.lacks_channels) +
                     (hello.lacks_channels && hello.lacks_inputs ? " and no " : "") +
                     listed("analog input", hello.lacks_inputs) +
                     ", which robot.xml uses; mend robot.xml, or fit the board");
}

void GatewayNode::say_boot_or_fault(const erp::EcuEmergency& emergency) {
  const frame_emergency& said = emergency.said;
  if (!said.boot)
    return node_.report(
        erp::Severity::fault, ecu_name(emergency.ecu), "emergency",
        "channel " + std::to_string(said.channel) + ": " + ecu_fault_name(said.fault));
  const bool on_purpose = said.reset_cause == FRAME_RESET_POWER;
  node_.report(on_purpose ? erp::Severity::info : erp::Severity::warning, ecu_name(emergency.ecu),
               "boot", std::string("the ECU has started: ") + reset_words(said.reset_cause));
  if (said.version != FRAME_VERSION)
    node_.report(erp::Severity::fault, ecu_name(emergency.ecu), "ecu_version",
                 version_words(said.version));
}

void GatewayNode::say_ecu(int ecu, erp::EcuWatch::News news) {
  const std::string& drives = drives_[static_cast<std::size_t>(ecu)];
  const std::string whose = drives.empty() ? "" : " (" + drives + ")";
  switch (news) {
    case erp::EcuWatch::News::silent:
      return node_.report(erp::Severity::warning, ecu_name(ecu), "ecu_silent",
                          "no frame for 10 ms" + whose);
    case erp::EcuWatch::News::lost:
      return node_.report(erp::Severity::fault, ecu_name(ecu), "ecu_lost",
                          "no frame for 50 ms" + whose + ": power, cable, or its program");
    case erp::EcuWatch::News::back:
      return node_.report(erp::Severity::info, ecu_name(ecu), "ecu_back", "speaks again" + whose);
  }
}

void GatewayNode::say_unanswered() {
  for (const int ecu : ecus_)
    if (!gateway_.understands(ecu))
      node_.report(erp::Severity::warning, ecu_name(ecu), "ecu_unanswered",
                   "has not said what it is for a second: power, cable, address, or "
                   "firmware of another version");
}

void GatewayNode::say_counters() {
  const auto now = gateway_.counters();
  const auto say = [&](std::uint64_t count, std::uint64_t before, const std::string& subject,
                       const char* what) {
    if (count > before)
      node_.report(erp::Severity::warning, subject, what,
                   std::to_string(count - before) + " " + what + " more, " + std::to_string(count) +
                       " in all");
  };
  say(now.corrupt, said_.corrupt, "bus", "corrupt_frames");
  say(now.lost, said_.lost, "bus", "lost_frames");
  say(now.foreign, said_.foreign, "bus", "foreign_frames");
  say(now.incomplete_ticks, said_.incomplete_ticks, "bus", "incomplete_ticks");
  said_ = now;
  for (std::size_t k = 0; k < buses_.size(); ++k) {
    const std::uint64_t expired = buses_[k].outbox().expired() + buses_[k].outbox().dropped();
    say(expired, refused_said_[k], buses_[k].name(), "frames_not_sent");
    refused_said_[k] = expired;
  }
  show_counters();
}

void GatewayNode::show_counters() {
  const auto& now = said_;
  node_.show("corrupt", static_cast<double>(now.corrupt));
  node_.show("lost", static_cast<double>(now.lost));
  node_.show("late", static_cast<double>(now.late));
  node_.show("foreign", static_cast<double>(now.foreign));
  node_.show("ticks_left_out", static_cast<double>(ticks_left_out_));
  node_.show("incomplete_ticks", static_cast<double>(now.incomplete_ticks));
  const std::int64_t now_ns = node::monotonic_ns();
  const double elapsed_s = 1e-9 * static_cast<double>(now_ns - counted_ns_);
  for (std::size_t k = 0; k < buses_.size(); ++k) show_bus(k, elapsed_s);
  counted_ns_ = now_ns;
}

void GatewayNode::show_bus(std::size_t k, double elapsed_s) {
  erp::BusKeeper& bus = buses_[k];
  const erp::BusCounters now = bus.counters();
  const std::uint64_t frames = now.sent + now.received;
  const auto show = [&](const char* what, double value) {
    node_.show(bus.name() + "." + what, value);
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
