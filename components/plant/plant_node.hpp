#pragma once
#include <set>
#include <string>
#include <vector>

#include "components/node/node.hpp"
#include "components/plant/plant.hpp"

/// The plant on the bus.
///
/// Real time: a controller's command goes to the device as it arrives; a frame that no controller
/// answered before the next one is answered by the plant alone, so the ECUs hear from it each tick.
/// Lockstep: a frame is answered once every controller on the bus has answered it.
namespace plant {

class PlantNode {
 public:
  using Params = Plant::Params;
  PlantNode(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  void on_frame(const erp::EcuFrame& frame);
  void on_command(const erp::ActuatorCommand& command);
  void on_gains(const erp::GainCommand& command);
  bool all_answered() const;
  void answer();
  void repeat_answer();
  void refuse_gain(const erp::GainValue& gain);
  void send_gains();
  void say_notices();
  void publish_owners();

  struct Answer {
    std::string controller;
    std::uint64_t answers;
  };

  node::Node& node_;
  Plant plant_;
  std::vector<std::string> names_;
  std::vector<std::vector<erp::EcuParameterValue>> gains_;  ///< one list an actuator
  node::Publisher<erp::SensorFrame>& sensor_out_;
  node::Publisher<erp::EcuCommand>& ecu_out_;
  node::Publisher<erp::EcuParameter>& parameter_out_;
  node::Publisher<erp::ActuatorOwner>& owner_out_;
  node::Subscription<erp::ActuatorCommand>* command_in_;
  std::vector<Answer> answers_;
  std::set<std::string> refused_gains_;  ///< said already
  std::uint64_t frame_ = 0, frames_ = 0;
  bool heard_ = false, owes_answer_ = false;
  std::int64_t owed_since_ns_ = 0;
};

}  // namespace plant
