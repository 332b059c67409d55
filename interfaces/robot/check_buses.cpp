#include <algorithm>
#include <map>

#include "interfaces/robot/check.hpp"
#include "interfaces/xml/values.hpp"

namespace erp::robot_check {
namespace {

constexpr std::size_t max_bus_name_length = 16;

std::string ecu_text(int ecu) { return "ECU " + std::to_string(ecu); }

/// Checks that every ECU of a bus is in use and is on no other bus.
void check_members(const BusPlan& bus, const std::vector<int>& used_ecus,
                   std::map<int, const BusPlan*>& bus_of_ecu, Findings& findings) {
  for (const int ecu : bus.ecus) {
    const auto [first, is_free] = bus_of_ecu.emplace(ecu, &bus);
    if (!is_free)
      findings.add(bus, ecu_text(ecu) + " is already on bus " + xml::quote(first->second->name),
                   "keep it on one; the first is at " + place_text(first->second->place));
    if (std::ranges::find(used_ecus, ecu) == used_ecus.end())
      findings.add(
          bus, ecu_text(ecu) + " drives no actuator and reads no sensor",
          "remove it from the bus; ECUs in use: " + xml::Codec<std::vector<int>>::write(used_ecus));
  }
}

void check_bus(const BusPlan& bus, Findings& findings) {
  if (bus.name.size() > max_bus_name_length)
    findings.add(
        bus,
        "name=" + xml::quote(bus.name) + " has " + std::to_string(bus.name.size()) + " characters",
        "published values contain its name: give at most " + std::to_string(max_bus_name_length));
  if (bus.data_bitrate_per_s && *bus.data_bitrate_per_s < bus.bitrate_per_s)
    findings.add(bus,
                 "data_bitrate_per_s=\"" + xml::write_number(*bus.data_bitrate_per_s) +
                     "\" is below bitrate_per_s=\"" + xml::write_number(bus.bitrate_per_s) + "\"",
                 "CAN FD sends data at least as fast as identifiers; leave it out for classic CAN");
}

}  // namespace

void check_buses(const Robot& robot, Findings& findings) {
  const std::vector<int> used_ecus = robot.ecus();
  std::map<int, const BusPlan*> bus_of_ecu;
  for (const BusPlan& bus : robot.can_buses) {
    check_members(bus, used_ecus, bus_of_ecu, findings);
    check_bus(bus, findings);
  }
  if (robot.can_buses.empty()) return;
  for (const int ecu : used_ecus)
    if (!bus_of_ecu.contains(ecu))
      findings.add(robot, ecu_text(ecu) + " is on no CAN bus",
                   "name it in the ecus of a <can_bus>");
}

}  // namespace erp::robot_check
