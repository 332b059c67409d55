#include "components/node/peer.hpp"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "components/node/clock.hpp"

namespace node {
namespace {

std::string own_host() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 ? name : "";
}

/// False also for a zombie process: state Z of proc(5) stat.
bool runs(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  if (!std::getline(file, text)) return false;
  const auto state = text.find_first_not_of(' ', text.rfind(')') + 1);
  return state != text.npos && text[state] != 'Z';
}

}  // namespace

Peer own_peer(const std::string& component, const std::string& robot, const std::string& role) {
  return {component, robot, role.empty() ? component : role, own_host(), getpid(), wall_ns()};
}

std::string to_user_data(const Peer& peer) {
  std::ostringstream text;
  text << "component=" << peer.component << ";robot=" << peer.robot << ";role=" << peer.role
       << ";host=" << peer.host << ";pid=" << peer.pid << ";joined_ns=" << peer.joined_ns
       << ";active=" << peer.active << ';';
  return text.str();
}

Peer parse_peer(const std::string& user_data) {
  Peer peer;
  if (!user_data.starts_with("component=")) return peer.component = user_data, peer;
  std::istringstream pairs(user_data);
  for (std::string pair; std::getline(pairs, pair, ';');) {
    const auto equals = pair.find('=');
    if (equals == pair.npos) continue;
    const std::string key = pair.substr(0, equals), value = pair.substr(equals + 1);
    if (key == "component") peer.component = value;
    else if (key == "robot") peer.robot = value;
    else if (key == "role") peer.role = value;
    else if (key == "active") peer.active = value == "1";
    else if (key == "host") peer.host = value;
    else if (key == "pid") peer.pid = static_cast<pid_t>(std::strtol(value.c_str(), nullptr, 10));
    else if (key == "joined_ns") peer.joined_ns = std::strtoll(value.c_str(), nullptr, 10);
  }
  if (peer.role.empty()) peer.role = peer.component;
  return peer;
}

bool may_be_alive(const Peer& peer) { return peer.host != own_host() || runs(peer.pid); }

}  // namespace node
