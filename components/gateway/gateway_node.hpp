#pragma once
#include <optional>
#include <string>
#include <vector>

#include "components/node/node.hpp"
#include "hal/can/bus_keeper.hpp"
#include "hal/can/ecu_watch.hpp"
#include "hal/can/gateway.hpp"
#include "hal/can/robot_buses.hpp"

/// The device "can": the plant's messages to the ECUs' frames and back, on the robot's buses.
/// Frames go out the moment their message arrives; a tick is published the moment it is whole.
namespace can {

class GatewayNode {
 public:
  struct Params {
    std::string bus = "udp:239.255.42.1:20000";  ///< as erp::open_buses takes it
    /// "": none; else every frame goes to this file; of several buses to one each, run.log to
    /// run.left.log.
    std::string trace;
    void visit(auto& v) { v("bus", bus), v("trace", trace); }
  };
  GatewayNode(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  void open(const Params& params, const erp::Robot& robot);
  void receive(erp::BusKeeper& bus);
  /// A silent ECU must not hold back what the others said.
  void close_late_tick();
  void take_tick();
  void publish_tick();
  void publish_clock();
  void on_command(const erp::EcuCommand& command);
  void send(std::span<const erp::CanFrame> frames);
  /// Real time, for what may grow too old; 0 in lockstep, where nothing does.
  std::int64_t now_ns() const;
  void mind();
  void discover();

  // gateway_news.cpp: what it says, and shows in its heartbeat
  void say_news();
  void say_hello(const erp::EcuHello& hello);
  void say_boot_or_fault(const erp::EcuEmergency& emergency);
  void say_ecu(int ecu, erp::EcuWatch::News news);
  void say_unanswered();
  void say_counters();
  void show_counters();
  void show_bus(std::size_t bus, double elapsed_s);

  node::Node& node_;
  erp::BusRoutes routes_;
  std::vector<erp::BusKeeper> buses_;  ///< one of routes_, or one for all (a trace)
  erp::Gateway gateway_;
  erp::EcuWatch watch_;
  std::vector<int> ecus_;
  std::vector<std::string> drives_;   ///< by ECU: the actuators on it, for people
  std::vector<double> frame_time_s_;  ///< of each bus, worst case
  node::Publisher<erp::EcuFrame>& frame_out_;
  node::Publisher<erp::Clock>& clock_out_;
  node::Subscription<erp::EcuParameter>* parameter_in_;
  std::uint64_t end_sequence_;
  erp::GatewayCounters said_;
  std::vector<std::uint64_t> refused_said_, frames_before_;
  std::int64_t began_ns_ = 0;
  std::optional<std::int64_t> open_since_ns_;  ///< when the tick at hand began to be heard
  std::int64_t counted_ns_ = 0;
  bool tick_waits_ = false;  ///< heard whole, not yet published
  std::uint64_t ticks_left_out_ = 0;
  int asked_ = 0;  ///< DISCOVERs sent
};

}  // namespace can
