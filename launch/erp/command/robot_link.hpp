#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/node/bus.hpp"
#include "components/node/peer.hpp"
#include "interfaces/emergency.hpp"
#include "interfaces/topics.hpp"
#include "launch/erp/inspect/discovery_listener.hpp"

/// The connection of a verb to the running robots on the bus. It commands like a controller: through
/// the plant and with a priority.
namespace launch {

class RobotLink {
 public:
  /// The newest messages of one robot.
  struct Robot {
    erp::SensorFrame frame;
    std::optional<erp::ActuatorOwner> owners;
    std::optional<erp::EcuFrame> ecus;
    bool has_actuator(const std::string& name) const { return sample(name) != nullptr; }
    /// nullptr: no such actuator, or no message yet.
    const erp::ActuatorSample* sample(const std::string& actuator) const;
    const erp::ActuatorOwnerSample* owner(const std::string& actuator) const;
    const erp::EcuChannelSample* channel(const std::string& actuator) const;
  };

  /// `controller`: name of the sender in commands.
  RobotLink(const std::string& verb, std::string controller)
      : bus_(verb), controller_(std::move(controller)) {}
  const std::string& controller() const { return controller_; }

  /// Calls `callback` at each message and at least every 50 ms, until it returns true, the duration
  /// has passed or a signal arrives. Returns false after a signal.
  bool watch(std::int64_t duration_ns, const std::function<bool()>& callback);
  /// Collects the robots that publish within the discovery time + 0.3 s. Throws std::runtime_error if
  /// there is none, or after a signal.
  void find_robots();
  /// The robot with this name; an empty name: the only one. Throws std::invalid_argument with the
  /// names of all robots.
  std::string choose(const std::string& name) const;
  std::map<std::string, Robot>& robots() { return robots_; }
  /// Robots with a plant that publish no frame.
  const std::set<std::string>& silent_robots() const { return silent_robots_; }
  Robot& robot(const std::string& name) { return robots_.at(name); }

  /// The other participants on the bus, at the time of find_robots.
  const std::vector<node::Peer>& peers() const { return peers_; }

  void command(const std::string& robot, const std::vector<erp::ActuatorReference>& references,
               std::int32_t priority);
  /// Sends one reference for each of the actuators; `mode`: erp::Mode or erp::release_mode.
  void command(const std::string& robot, const std::vector<std::string>& actuators,
               std::uint8_t mode, double reference, std::int32_t priority);
  void send(erp::GainCommand& gains, const std::string& robot, std::int32_t priority);

 private:
  void take();

  DiscoveryListener bus_;
  std::string controller_;
  /// Created with the first command: in lockstep the plant waits for every controller.
  std::optional<node::Writer<erp::ActuatorCommand>> commands_;
  node::Writer<erp::GainCommand> gains_{bus_.participant()};
  node::Reader<erp::SensorFrame> frames_{bus_.participant(), bus_.wake()};
  node::Reader<erp::ActuatorOwner> owners_{bus_.participant(), bus_.wake()};
  node::Reader<erp::EcuFrame> ecus_{bus_.participant(), bus_.wake()};
  std::map<std::string, Robot> robots_;
  std::set<std::string> silent_robots_;
  std::vector<node::Peer> peers_;
};

/// The names of all actuators of a robot.
std::vector<std::string> actuators_of(const RobotLink::Robot& robot);

}  // namespace launch
