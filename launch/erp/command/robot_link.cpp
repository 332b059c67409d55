#include "launch/erp/command/robot_link.hpp"

#include <algorithm>
#include <stdexcept>

#include "components/node/clock.hpp"
#include "components/node/peers.hpp"
#include "interfaces/xml/words.hpp"

namespace launch {
namespace {

template <class List>
auto* find_by_name(const List& list, const std::string& name) {
  const auto samples = erp::samples(list);
  const auto found =
      std::ranges::find_if(samples, [&](const auto& sample) { return name == sample.name; });
  return found == samples.end() ? nullptr : &*found;
}

}  // namespace

const erp::ActuatorSample* RobotLink::Robot::sample(const std::string& actuator) const {
  return find_by_name(frame.actuators, actuator);
}

const erp::ActuatorOwnerSample* RobotLink::Robot::owner(const std::string& actuator) const {
  return owners ? find_by_name(owners->actuators, actuator) : nullptr;
}

/// ecu_frame and sensor_frame have the actuators in the same order.
const erp::EcuChannelSample* RobotLink::Robot::channel(const std::string& actuator) const {
  if (!ecus) return nullptr;
  const auto names = actuators_of(*this);
  const auto index = std::ranges::find(names, actuator) - names.begin();
  const auto channels = erp::samples(ecus->channels);
  return static_cast<std::size_t>(index) < channels.size()
             ? &channels[static_cast<std::size_t>(index)]
             : nullptr;
}

std::vector<std::string> actuators_of(const RobotLink::Robot& robot) {
  std::vector<std::string> names;
  for (const auto& sample : erp::samples(robot.frame.actuators)) names.push_back(sample.name);
  return names;
}

void RobotLink::take() {
  frames_.take([&](const auto& frame) { robots_[frame.robot].frame = frame; });
  owners_.take([&](const auto& owners) { robots_[owners.robot].owners = owners; });
  ecus_.take([&](const auto& frame) { robots_[frame.robot].ecus = frame; });
}

bool RobotLink::watch(std::int64_t duration_ns, const std::function<bool()>& callback) {
  return bus_.watch(duration_ns, [&] {
    take();
    return callback();
  });
}

void RobotLink::find_robots() {
  constexpr std::int64_t margin_ns = 300'000'000;  // chosen: owners are published at 10 Hz
  node::Wake wake;
  node::Peers peers(bus_.participant(), wake, node::own_peer(controller_, ""));
  if (!watch(node::discovery_ns() + margin_ns, [] { return false; }))
    throw std::runtime_error("interrupted");
  peers.discover();
  peers_ = peers.others();
  std::erase_if(robots_, [](const auto& entry) { return !entry.second.frame.actuators._length; });
  for (const auto& peer : peers.others())
    if (peer.role == node::plant_role && !robots_.contains(peer.robot))
      silent_robots_.insert(peer.robot);
  if (robots_.empty() && silent_robots_.empty())
    throw std::runtime_error(
        "no robot is running on the bus; start a graph, or set ERP_DOMAIN to the domain of its "
        "launcher");
}

std::string RobotLink::choose(const std::string& name) const {
  std::vector<std::string> names;
  for (const auto& [robot, newest] : robots_) names.push_back(robot);
  if (name.empty() && names.size() == 1) return names.front();
  if (std::ranges::find(names, name) != names.end()) return name;
  if (!name.empty())
    throw std::invalid_argument("no robot \"" + name + "\" is running; " +
                                xml::did_you_mean(name, names));
  std::string all;
  for (const auto& robot : names) all += (all.empty() ? "" : ", ") + robot;
  throw std::invalid_argument("several robots are running: " + all + "; choose one with --robot");
}

void RobotLink::command(const std::string& robot,
                        const std::vector<erp::ActuatorReference>& references,
                        std::int32_t priority) {
  erp::ActuatorCommand message;
  erp::assign(message.robot, robot);
  erp::assign(message.controller, controller_);
  message.stamp_ns = node::wall_ns();
  message.answers = robots_.at(robot).frame.sequence;
  message.priority = priority;
  for (const auto& reference : references) erp::append(message.actuators, reference);
  if (!commands_) commands_.emplace(bus_.participant());
  commands_->write(message);
}

void RobotLink::command(const std::string& robot, const std::vector<std::string>& actuators,
                        std::uint8_t mode, double reference, std::int32_t priority) {
  std::vector<erp::ActuatorReference> references;
  for (const auto& actuator : actuators) {
    erp::ActuatorReference& added = references.emplace_back();
    erp::assign(added.name, actuator);
    added.mode = mode;
    added.reference = reference;
  }
  command(robot, references, priority);
}

void RobotLink::send(erp::GainCommand& gains, const std::string& robot, std::int32_t priority) {
  erp::assign(gains.robot, robot);
  erp::assign(gains.controller, controller_);
  gains.stamp_ns = node::wall_ns();
  gains.priority = priority;
  gains_.write(gains);
}

}  // namespace launch
