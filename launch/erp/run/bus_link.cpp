#include "launch/erp/run/bus_link.hpp"

#include "components/node/clock.hpp"

namespace launch {

BusLink::BusLink(std::string robot)
    : robot_(std::move(robot)),
      self_(node::own_peer("erp", "")),
      participant_(node::join(self_)),
      peers_(participant_, wake_, self_),
      states_(participant_, wake_, erp::Topic<erp::ComponentState>::depth, robot_),
      events_(participant_, wake_, erp::Topic<erp::Event>::depth, robot_),
      clock_(participant_, clock_wake_, erp::Topic<erp::Clock>::depth, robot_),
      commands_(participant_, erp::Topic<erp::LifecycleCommand>::depth) {}

void BusLink::poll(const Handlers& handlers) {
  wake_.clear();
  states_.take(handlers.state);
  events_.take(handlers.event);
  clock_.take(handlers.clock);
}

std::vector<node::Peer> BusLink::peers() {
  peers_.discover();
  std::vector<node::Peer> found;
  for (const auto& peer : peers_.others())
    if (peer.robot == robot_) found.push_back(peer);
  return found;
}

void BusLink::command(const std::string& component, erp::Lifecycle target) {
  erp::LifecycleCommand command;
  erp::assign(command.robot, robot_);
  erp::assign(command.component, component);
  command.stamp_ns = node::wall_ns();
  command.target = static_cast<std::uint8_t>(target);
  commands_.write(command);
}

}  // namespace launch
