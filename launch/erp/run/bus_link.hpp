#pragma once
#include <functional>
#include <string>

#include "components/node/bus.hpp"
#include "components/node/peers.hpp"
#include "interfaces/values.hpp"

/// The DDS participant of the launcher: receives messages from the components of one robot, and
/// sends lifecycle commands to them.
namespace launch {

class BusLink {
 public:
  explicit BusLink(std::string robot);

  struct Handlers {
    std::function<void(const erp::ComponentState&)> state;
    std::function<void(const erp::Event&)> event;
    std::function<void(const erp::Clock&)> clock;
  };
  /// Passes each message received since the last call to its handler.
  void poll(const Handlers& handlers);
  /// Every participant of the robot on the bus, including the launcher.
  std::vector<node::Peer> peers();
  void command(const std::string& component, erp::Lifecycle target);
  int descriptor() const { return wake_.descriptor(); }  ///< readable when a message has arrived

 private:
  std::string robot_;
  node::Peer self_;
  node::Entity participant_;
  node::Wake wake_;
  node::Peers peers_;
  node::Wake clock_wake_;  ///< not polled: thousands of ticks per second must not wake the launcher
  node::Reader<erp::ComponentState> states_;
  node::Reader<erp::Event> events_;
  node::Reader<erp::Clock> clock_;
  node::Writer<erp::LifecycleCommand> commands_;
};

}  // namespace launch
