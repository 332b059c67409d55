#pragma once
#include <functional>
#include <string>

#include "components/node/bus.hpp"
#include "components/node/peers.hpp"
#include "interfaces/values.hpp"

/// The launcher's end of the bus: hears the components of one robot, and tells them to activate.
namespace launch {

class BusLink {
 public:
  explicit BusLink(std::string robot);

  struct Hearing {
    std::function<void(const erp::ComponentState&)> state;
    std::function<void(const erp::Event&)> event;
    std::function<void(const erp::Clock&)> clock;
  };
  /// Hands over everything that arrived since the last call.
  void poll(const Hearing& hearing);
  /// Every participant of the robot that is on the bus, ours too.
  std::vector<node::Peer> peers();
  void command(const std::string& component, erp::Lifecycle target);
  int descriptor() const { return wake_.descriptor(); }  ///< readable when something arrived

 private:
  std::string robot_;
  node::Peer self_;
  node::Entity participant_;
  node::Wake wake_;
  node::Peers peers_;
  node::Wake unheeded_;  ///< the clock's: thousands of ticks a second need not wake us
  node::Reader<erp::ComponentState> states_;
  node::Reader<erp::Event> events_;
  node::Reader<erp::Clock> clock_;
  node::Writer<erp::LifecycleCommand> commands_;
};

}  // namespace launch
