#pragma once
#include <string>
#include <vector>

#include "components/node/node.hpp"
#include "components/plant/plant.hpp"

/// The plant on the bus.
///
/// Real time: a controller's command is passed to the device as soon as it arrives. If no
/// controller answers a frame before the next frame, the plant answers it, so the ECUs receive a
/// command in each period. Lockstep: the plant answers a frame once every controller has answered
/// it.
namespace plant {

class PlantNode {
 public:
  using Params = Plant::Params;
  static const char* role(const Params&) { return node::plant_role; }
  PlantNode(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  void on_frame(const erp::EcuFrame& frame);
  void on_command(const erp::ActuatorCommand& command);
  void store_answer(const erp::ActuatorCommand& command);
  bool all_answered() const;
  void answer();
  void repeat_answer();
  void send_gains(bool load);
  void report_notices();
  void publish_owners();

  struct Answer {
    std::string controller;
    std::uint64_t answers;
  };

  node::Node& node_;
  Plant plant_;
  node::Publisher<erp::SensorFrame>& sensor_out_;
  node::Publisher<erp::EcuCommand>& ecu_out_;
  node::Publisher<erp::EcuParameter>& parameter_out_;
  node::Publisher<erp::ActuatorOwner>& owner_out_;
  node::Subscription<erp::ActuatorCommand>* command_in_;
  std::vector<Answer> answers_;  ///< in lockstep
  std::uint64_t current_frame_ = 0, frame_count_ = 0;
  bool frame_received_ = false, answer_pending_ = false;
  std::int64_t pending_since_ns_ = 0;
};

}  // namespace plant
