#pragma once
#include <sys/types.h>

#include <cstdint>
#include <string>
#include <tuple>

/// The identity of a participant on the bus, from its user data.
namespace node {

struct Peer {
  std::string component;
  std::string robot;  ///< empty for tools
  /// A robot has one participant of each role. Default: the component's name, so names are unique.
  std::string role;
  std::string host;
  pid_t pid = 0;
  std::int64_t joined_ns = 0;  ///< wall time; decides between two that start together
  bool active = false;         ///< takes part in the control of the robot
};

/// Roles of components that a robot has once, whatever their names: the layer between controllers
/// and ECUs, and the robot itself or its substitute.
inline constexpr const char plant_role[] = "plant";
inline constexpr const char device_role[] = "device";

/// The identity of this process, with the current time as joined_ns.
Peer own_peer(const std::string& component, const std::string& robot, const std::string& role = "");

/// `component=plant;robot=arm;role=plant;host=lab;pid=12;joined_ns=…;active=0;`
std::string to_user_data(const Peer& peer);
/// Takes user data of any other form as the component name; the other fields stay empty.
Peer parse_peer(const std::string& user_data);

/// False only when the peer ran on this machine and its process has ended. DDS lists a killed
/// participant until its lease expires.
bool may_be_alive(const Peer& peer);

/// True for two processes with the same name or role and the same robot.
inline bool are_duplicates(const Peer& a, const Peer& b) {
  return (a.component == b.component || a.role == b.role) && a.robot == b.robot &&
         !a.robot.empty() && (a.host != b.host || a.pid != b.pid);
}
/// True if `self` must end because of the duplicate `other`. An active process never ends, whatever
/// the other claims. An inactive one ends if the other is active. If neither is active, the one that
/// joined later ends.
inline bool yields_to(const Peer& self, const Peer& other) {
  if (self.active || other.active) return !self.active;
  return std::tie(other.joined_ns, other.host, other.pid) <
         std::tie(self.joined_ns, self.host, self.pid);
}

}  // namespace node
