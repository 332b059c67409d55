#pragma once
#include <sys/types.h>

#include <cstdint>
#include <string>
#include <tuple>

/// Who a participant on the bus is, as it says itself in its user data.
namespace node {

struct Peer {
  std::string component;
  std::string robot;  ///< empty: of no robot, such as a tool
  std::string host;
  pid_t pid = 0;
  std::int64_t joined_ns = 0;  ///< wall time; the earlier of two namesakes stays
};

/// This process, under that name, now.
Peer own_peer(const std::string& component, const std::string& robot);

/// `component=plant;robot=arm;host=lab;pid=12;joined_ns=…;`
std::string to_user_data(const Peer& peer);
/// Any other text is the name of a component of which nothing else is known.
Peer parse_peer(const std::string& user_data);

/// False only when it ran on this machine and its process is gone: DDS keeps a killed
/// participant for the length of its lease.
bool may_be_alive(const Peer& peer);

/// Two processes that claim to be the same part of one robot.
inline bool namesakes(const Peer& a, const Peer& b) {
  return a.component == b.component && a.robot == b.robot && !a.robot.empty() &&
         (a.host != b.host || a.pid != b.pid);
}
inline bool joined_before(const Peer& a, const Peer& b) {
  return std::tie(a.joined_ns, a.host, a.pid) < std::tie(b.joined_ns, b.host, b.pid);
}

}  // namespace node
