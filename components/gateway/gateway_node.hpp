#pragma once
#include <optional>
#include <string>
#include <vector>

#include "components/node/node.hpp"
#include "hal/can/bus_keeper.hpp"
#include "hal/can/ecu_watch.hpp"
#include "hal/can/gateway.hpp"
#include "hal/can/robot_buses.hpp"

/// The device "can": translates the plant's messages to frames on the robot's CAN buses, and back.
/// Frames are sent as soon as their message arrives; a tick is published as soon as it is complete.
namespace can {

class GatewayNode {
 public:
  struct Params {
    std::string bus = "udp:239.255.42.1:20000";
    std::string trace;
    void visit(auto& v) {
      v("bus", bus,
        "CAN buses: udp:GROUP:PORT (virtual), socketcan:INTERFACE or trace:FILE. One per bus of "
        "robot.xml, separated by spaces, or one for all: its last number increases from bus to "
        "bus.");
      v("trace", trace,
        "File for a trace of all frames, as of candump -L; empty: none. With several buses "
        "run.log becomes run.left.log for the bus left.");
    }
  };
  static const char* role(const Params&) { return node::device_role; }
  GatewayNode(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  void open(const Params& params, const erp::Robot& robot);
  void receive(erp::BusKeeper& bus);
  /// Publishes an incomplete tick, so that a silent ECU does not delay the data of the others.
  void close_overdue_tick();
  void on_tick_complete();
  void publish_tick();
  void publish_clock();
  void on_command(const erp::EcuCommand& command);
  void send(std::span<const erp::CanFrame> frames);
  /// Real time, for the age of frames; 0 in lockstep, where frames do not age.
  std::int64_t now_ns() const;
  void supervise();
  void discover();

  // gateway_events.cpp: events and heartbeat figures
  void report_events();
  void report_hello(const erp::EcuHello& hello);
  void report_boot_or_fault(const erp::EcuEmergency& emergency);
  void report_ecu(int ecu, erp::EcuWatch::Event event);
  void report_unanswered();
  void report_counters();
  void show_counters();
  void show_bus(std::size_t bus, double elapsed_s);

  node::Node& node_;
  erp::BusRoutes routes_;
  std::vector<erp::BusKeeper> buses_;  ///< one per bus of routes_; a trace: one for all
  erp::Gateway gateway_;
  erp::EcuWatch watch_;
  std::vector<int> ecus_;
  std::vector<std::string> actuators_on_;  ///< by ECU: names of its actuators, for messages
  std::vector<double> frame_time_s_;       ///< of each bus, worst case
  node::Publisher<erp::EcuFrame>& frame_out_;
  node::Publisher<erp::Clock>& clock_out_;
  node::Subscription<erp::EcuParameter>* parameter_in_;
  std::uint64_t end_sequence_;
  erp::GatewayCounters reported_counters_;
  std::vector<std::uint64_t> unsent_reported_, unrecorded_reported_, frames_before_;
  std::int64_t activated_ns_ = 0;
  std::optional<std::int64_t> open_since_ns_;  ///< when the first frame of the current tick arrived
  std::int64_t last_counters_ns_ = 0;
  bool tick_pending_ = false;  ///< complete, not yet published
  std::uint64_t ticks_skipped_ = 0;
  int discovers_sent_ = 0;  ///< number of DISCOVER frames
};

}  // namespace can
