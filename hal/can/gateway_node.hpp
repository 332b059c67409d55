#pragma once
#include <memory>
#include <optional>
#include <string>

#include "components/node/node.hpp"
#include "hal/can/bus.hpp"
#include "hal/can/gateway.hpp"

/// The device "can": the plant's messages to the ECUs' frames and back, on one bus.
/// Frames go out the moment their message arrives; a tick is published the moment it is whole.
namespace can {

class GatewayNode {
 public:
  struct Params {
    std::string bus = "udp:239.255.42.1:20000";  ///< or socketcan:IFACE
    void visit(auto& v) { v("bus", bus); }
  };
  GatewayNode(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  void receive();
  /// A silent ECU must not hold back what the others said.
  void close_late_tick();
  void publish_tick();
  void publish_clock();
  void on_command(const erp::EcuCommand& command);
  void send(std::span<const erp::CanFrame> frames);
  void say_emergencies();
  void say_counters();

  node::Node& node_;
  std::unique_ptr<erp::CanBus> bus_;
  erp::Gateway gateway_;
  node::Publisher<erp::EcuFrame>& frame_out_;
  node::Publisher<erp::Clock>& clock_out_;
  node::Subscription<erp::EcuParameter>* parameter_in_;
  std::uint64_t end_sequence_;
  erp::GatewayCounters said_;
  std::uint64_t refused_said_ = 0;
  std::optional<std::int64_t> open_since_ns_;  ///< when the tick at hand began to be heard
};

}  // namespace can
