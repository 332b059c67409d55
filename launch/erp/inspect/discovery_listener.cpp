#include "launch/erp/inspect/discovery_listener.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <set>

#include "components/node/clock.hpp"
#include "components/node/peers.hpp"
#include "interfaces/xml/words.hpp"

namespace launch {
namespace {

// Chosen: 20 participants on one machine need 0.3 s more than two to discover each other.
constexpr std::int64_t more_ns = 400'000'000, timeout_ns = 5'000'000'000;
constexpr int longest_sleep_ms = 50;

}  // namespace

DiscoveryListener::DiscoveryListener(const std::string& verb)
    : name_("erp " + verb + " " + std::to_string(getpid())),
      participant_(node::join(name_)),
      discovery_(participant_, wake_) {}

bool DiscoveryListener::watch(std::int64_t duration_ns, const std::function<bool()>& act) {
  const std::int64_t end_ns = node::monotonic_ns() + duration_ns;
  while (!act() && node::monotonic_ns() < end_ns) {
    pollfd polled[]{{wake_.descriptor(), POLLIN, 0}, {signals_.descriptor(), POLLIN, 0}};
    poll(polled, 2, longest_sleep_ms);
    wake_.clear();
    if (signals_.take()) return false;
  }
  return true;
}

bool DiscoveryListener::settle() {
  std::size_t known = 0;
  std::int64_t since_ns = node::monotonic_ns();
  const std::int64_t quiet_ns = node::discovery_ns() + more_ns;
  return watch(timeout_ns, [&] {
    const std::size_t now_known = endpoints().size();
    if (now_known != known) known = now_known, since_ns = node::monotonic_ns();
    return node::monotonic_ns() - since_ns >= quiet_ns;
  });
}

std::vector<node::Endpoint> DiscoveryListener::endpoints() {
  auto all = discovery_.endpoints();
  std::erase_if(all, [this](const node::Endpoint& e) { return e.component == name_; });
  return all;
}

node::Descriptor DiscoveryListener::find_type(const std::string& topic) {
  node::Descriptor type;
  watch(timeout_ns, [&] { return (type = discovery_.type_of(topic)) != nullptr; });
  if (type) return type;
  std::set<std::string> topics;
  for (const auto& endpoint : endpoints()) topics.insert(endpoint.topic);
  if (topics.contains(topic))
    throw NoSuchTopic("the type of \"" + topic + "\" could not be read from its writers; " +
                      "Cyclone DDS 0.10 cannot rebuild types whose key is a bounded string");
  const std::vector<std::string> known(topics.begin(), topics.end());
  throw NoSuchTopic(
      "topic \"" + topic + "\" has no writer and no reader; " +
      (known.empty()
           ? "the bus is empty; start a graph, or set ERP_DOMAIN to the domain of its launcher"
           : xml::did_you_mean(topic, known)));
}

}  // namespace launch
