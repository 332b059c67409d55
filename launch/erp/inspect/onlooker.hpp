#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "components/node/raw.hpp"
#include "interfaces/recording/type_description.hpp"
#include "launch/erp/run/signals.hpp"

/// A guest on the bus: joins, looks, listens, leaves. No daemon behind it.
namespace launch {

/// A topic that was asked for and did not turn up; says which did.
struct NoSuchTopic : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Onlooker {
 public:
  explicit Onlooker(const std::string& verb);

  const node::Entity& participant() const { return participant_; }
  node::Wake& wake() { return wake_; }

  /// Calls `act` whenever something arrives, and at least every 50 ms, until it returns true, the
  /// time is up or somebody interrupts. Returns false when interrupted.
  bool watch(std::int64_t duration_ns, const std::function<bool()>& act);
  /// Waits until what is on the bus has been found: nothing new for a while. False: interrupted.
  bool settle();
  /// Everybody's endpoints but our own.
  std::vector<node::Endpoint> endpoints();
  /// Waits for a topic's type. Throws NoSuchTopic with the nearest name when nobody has it.
  node::Descriptor find_type(const std::string& topic);

 private:
  Signals signals_;  // before the bus, whose threads inherit the mask
  std::string name_;
  node::Wake wake_;
  node::Entity participant_;
  node::Discovery discovery_;
};

}  // namespace launch
