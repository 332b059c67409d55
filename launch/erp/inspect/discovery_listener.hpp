#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "components/node/raw.hpp"
#include "interfaces/recording/type_description.hpp"
#include "launch/erp/run/signals.hpp"

/// DDS participant of a command line tool: joins the bus, discovers endpoints and types, leaves.
namespace launch {

/// The requested topic was not discovered; the message contains the most similar name.
struct NoSuchTopic : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class DiscoveryListener {
 public:
  explicit DiscoveryListener(const std::string& verb);

  const node::Entity& participant() const { return participant_; }
  node::Wake& wake() { return wake_; }

  /// Calls `callback` at each arrival of data and at least every 50 ms, until it returns true, the
  /// duration has passed or a signal arrives. Returns false after a signal.
  bool watch(std::int64_t duration_ns, const std::function<bool()>& callback);
  /// Waits until discovery yields no new endpoint for 0.4 s more than its usual duration, at most 5
  /// s. Returns false after a signal.
  bool settle();
  /// Endpoints of all other participants.
  std::vector<node::Endpoint> endpoints();
  /// Waits for the type of a topic. Throws NoSuchTopic with the most similar name if the topic does
  /// not exist.
  node::Descriptor find_type(const std::string& topic);

 private:
  Signals signals_;  // before participant_: its threads inherit the signal mask
  std::string name_;
  node::Wake wake_;
  node::Entity participant_;
  node::Discovery discovery_;
};

}  // namespace launch
