#include "launch/erp/inspect/doctor.hpp"

#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/timex.h>
#include <sys/utsname.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <ostream>

#include "components/node/clock.hpp"
#include "components/node/peers.hpp"
#include "components/node/real_time.hpp"
#include "components/node/security.hpp"
#include "hal/can/interface.hpp"
#include "interfaces/robot/robot.hpp"
#include "launch/erp/inspect/discovery_listener.hpp"
#include "launch/erp/inspect/reference.hpp"
#include "launch/erp/run/program.hpp"
#include "launch/erp/text/columns.hpp"

namespace launch {
namespace {

namespace fs = std::filesystem;
using Grade = Finding::Grade;
using Findings = std::vector<Finding>;

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

/// Interfaces of the network by name, with their flags IFF_….
std::map<std::string, unsigned> network_interfaces() {
  std::map<std::string, unsigned> flags;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return flags;
  for (const ifaddrs* entry = list; entry; entry = entry->ifa_next)
    flags[entry->ifa_name] = entry->ifa_flags;
  freeifaddrs(list);
  return flags;
}

void examine_programs(Findings& findings) {
  std::string missing;
  for (const auto& name : component_names())
    if (find_program(name, ".").empty()) missing += (missing.empty() ? "" : ", ") + name;
  if (missing.empty())
    findings.push_back({Grade::good, "programs", "all components are installed", ""});
  else
    findings.push_back({Grade::problem, "programs", "missing: " + missing,
                        "build them, or set ERP_COMPONENT_PATH to their folder"});
}

void examine_system(Findings& findings) {
  utsname system{};
  uname(&system);
  findings.push_back(
      {Grade::good, "kernel", std::string(system.sysname) + " " + system.release, ""});
  if (node::may_run_in_real_time())
    findings.push_back({Grade::good, "real-time priority", "permitted", ""});
  else
    findings.push_back(
        {Grade::warning, "real-time priority", "not permitted",
         "set ulimit -r to 20 (README.md, Run on hardware); without it, on a busy machine "
         "control loops miss deadlines"});
}

void examine_network(Findings& findings) {
  const auto interfaces = network_interfaces();
  const auto loopback = interfaces.find("lo");
  if (loopback != interfaces.end() && loopback->second & IFF_UP)
    findings.push_back({Grade::good, "loopback", "up", ""});
  else findings.push_back({Grade::problem, "loopback", "down", "sudo ip link set lo up"});
  std::string multicast;
  for (const auto& [name, flags] : interfaces)
    if (name != "lo" && flags & IFF_UP && flags & IFF_MULTICAST)
      multicast += (multicast.empty() ? "" : ", ") + name;
  findings.push_back({Grade::good, "other computers",
                      multicast.empty() ? "no network interface with multicast; this computer alone"
                                        : "interfaces with multicast: " + multicast,
                      ""});
}

void examine_bus(Findings& findings) {
  const char* domain = std::getenv("ERP_DOMAIN");
  const std::string name = std::string("DDS domain ") + (domain && *domain ? domain : "0");
  const char* configuration = std::getenv("CYCLONEDDS_URI");
  try {
    DiscoveryListener bus("doctor");
    node::Wake wake;
    node::Peers peers(bus.participant(), wake, node::own_peer("doctor", ""));
    bus.watch(node::discovery_ns(), [] { return false; });
    peers.discover();
    findings.push_back(
        {Grade::good, name,
         fmt::format("joined{}; {} other participants",
                     configuration ? " with CYCLONEDDS_URI" : " on the loopback", peers.count()),
         ""});
  } catch (const std::exception& error) {
    findings.push_back({Grade::problem, name, error.what(),
                        "end other programs of this domain, or set ERP_DOMAIN to another number, "
                        "0 to 230"});
  }
  if (const auto folder = node::security_folder(); !folder.empty())
    findings.push_back(
        {Grade::good, "security", folder + ", expires " + node::security_expires(), ""});
}

void examine_clocks(Findings& findings) {
  timex state{};
  const bool synchronized = adjtimex(&state) != TIME_ERROR;
  if (synchronized)
    findings.push_back({Grade::good, "wall clock", "synchronized by a time service", ""});
  else
    findings.push_back({Grade::warning, "wall clock", "not synchronized by a time service",
                        "install chrony; needed for correct dates, and for a robot of several "
                        "computers"});
  const std::string source =
      first_line("/sys/devices/system/clocksource/clocksource0/current_clocksource");
  findings.push_back({Grade::good, "monotonic clock", source.empty() ? "present" : source, ""});
}

bool is_can(const std::string& interface) {
  constexpr int can_device = 280;  // ARPHRD_CAN of linux/if_arp.h
  return first_line("/sys/class/net/" + interface + "/type") == std::to_string(can_device);
}

void examine_can(Findings& findings) {
  int count = 0;
  for (const auto& [name, flags] : network_interfaces()) {
    if (!is_can(name)) continue;
    ++count;
    const auto rate_per_s = erp::can::bitrate_per_s(name);
    const std::string rate =
        rate_per_s ? fmt::format("{:.0f} kbit/s", 1e-3 * *rate_per_s) : "no bit rate (virtual)";
    if (flags & IFF_UP) findings.push_back({Grade::good, "CAN " + name, "up, " + rate, ""});
    else
      findings.push_back({Grade::problem, "CAN " + name, "down",
                          "sudo ip link set " + name +
                              (name.starts_with("vcan") ? " up" : " up type can bitrate 1000000")});
  }
  if (count) return;
  findings.push_back({Grade::warning, "CAN", "no interface",
                      "only hardware needs one: connect the adapter, load its driver, then sudo ip "
                      "link set can0 up type can bitrate 1000000"});
}

/// Compares one bus of the robot with the interface that the gateway opens for it.
Finding compare(const erp::BusPlan& plan, const std::string& interface) {
  const std::string what = "bus " + plan.name + " on " + interface;
  const auto text = [](double per_s) { return fmt::format("{:.0f} kbit/s", 1e-3 * per_s); };
  const std::string planned = "robot.xml has " + text(plan.bitrate_per_s);
  if (!if_nametoindex(interface.c_str()))
    return {Grade::warning, what, "no such interface, " + planned, "connect the CAN adapter"};
  const auto rate_per_s = erp::can::bitrate_per_s(interface);
  if (rate_per_s && *rate_per_s == plan.bitrate_per_s)
    return {Grade::good, what, text(*rate_per_s), ""};
  return {Grade::warning, what, (rate_per_s ? text(*rate_per_s) : "no bit rate") + ", " + planned,
          fmt::format("sudo ip link set {0} down; sudo ip link set {0} up type can bitrate {1:.0f}",
                      interface, plan.bitrate_per_s)};
}

void examine_robot(const std::string& file, Findings& findings) {
  const erp::Robot robot = erp::read_robot(file);
  int number = 0;
  for (const erp::BusPlan& plan : robot.buses())
    findings.push_back(compare(plan, "can" + std::to_string(number++)));
}

void examine_disk(Findings& findings) {
  constexpr double min_free_GB = 1;  // chosen: some hours of the largest robot
  std::error_code error;
  const double free_GB = 1e-9 * static_cast<double>(fs::space(".", error).available);
  const std::string state =
      fmt::format("{:.1f} GB free in {}", free_GB, fs::current_path().string());
  if (!error && free_GB >= min_free_GB) findings.push_back({Grade::good, "disk", state, ""});
  else
    findings.push_back({Grade::problem, "disk", error ? error.message() : state,
                        error ? "change to a folder that can be read"
                              : "recordings stop when it is full: delete old runs in erp_runs"});
}

const char* word(Grade grade) {
  switch (grade) {
    case Grade::good:
      return "ok";
    case Grade::warning:
      return "warning";
    case Grade::problem:
      break;
  }
  return "PROBLEM";
}

}  // namespace

std::vector<Finding> examine(const std::string& robot) {
  Findings findings;
  examine_programs(findings);
  examine_system(findings);
  examine_network(findings);
  examine_bus(findings);
  examine_clocks(findings);
  examine_can(findings);
  if (!robot.empty()) examine_robot(robot, findings);
  examine_disk(findings);
  return findings;
}

int doctor(const std::string& robot, std::ostream& out) {
  const auto findings = examine(robot);
  std::vector<std::vector<std::string>> rows;
  int warnings = 0, problems = 0;
  for (const Finding& finding : findings) {
    rows.push_back({word(finding.grade), finding.what, finding.state});
    warnings += finding.grade == Grade::warning, problems += finding.grade == Grade::problem;
  }
  const auto lines = align(rows, {false, false, false});
  for (std::size_t k = 0; k < findings.size(); ++k) {
    out << lines[k] << '\n';
    if (!findings[k].remedy.empty()) out << "         → " << findings[k].remedy << '\n';
  }
  out << fmt::format("\n{} checks: {} problems, {} warnings\n", findings.size(), problems,
                     warnings);
  return problems ? 1 : 0;
}

}  // namespace launch
