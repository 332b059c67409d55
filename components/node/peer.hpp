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
  std::string host;
  pid_t pid = 0;
  std::int64_t joined_ns = 0;  ///< wall time; the earlier of two duplicates stays
};

/// The identity of this process, with the current time as joined_ns.
Peer own_peer(const std::string& component, const std::string& robot);

/// `component=plant;robot=arm;host=lab;pid=12;joined_ns=…;`
std::string to_user_data(const Peer& peer);
/// Takes user data of any other form as the component name; the other fields stay empty.
Peer parse_peer(const std::string& user_data);

/// False only when the peer ran on this machine and its process has ended. DDS lists a killed
/// participant until its lease expires.
bool may_be_alive(const Peer& peer);

/// True for two processes with the same component name and the same robot.
inline bool are_duplicates(const Peer& a, const Peer& b) {
  return a.component == b.component && a.robot == b.robot && !a.robot.empty() &&
         (a.host != b.host || a.pid != b.pid);
}
inline bool joined_before(const Peer& a, const Peer& b) {
  return std::tie(a.joined_ns, a.host, a.pid) < std::tie(b.joined_ns, b.host, b.pid);
}

}  // namespace node
