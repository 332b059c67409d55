#include "launch/erp/run/bus_link.hpp"

#include "components/node/clock.hpp"

namespace launch {

constexpr int event_depth = 64;  // queue length for a burst of events from one component; chosen

BusLink::BusLink(std::string robot)
    : robot_(std::move(robot)),
      self_(node::own_peer("erp", "")),
      participant_(node::join(self_)),
      peers_(participant_, wake_, self_),
      states_(participant_, wake_),
      events_(participant_, wake_, event_depth),
      clock_(participant_, clock_wake_),
      commands_(participant_) {}

void BusLink::poll(const Handlers& handlers) {
  wake_.clear();
  const auto of_robot = [this](const auto& handler) {
    return [this, &handler](const auto& message) {
      if (robot_ == message.robot) handler(message);
    };
  };
  states_.take(of_robot(handlers.state));
  events_.take(of_robot(handlers.event));
  clock_.take(of_robot(handlers.clock));
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
