#pragma once
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "components/node/node.hpp"
#include "interfaces/robot/robot.hpp"
#include "components/sim/bus_front.hpp"
#include "sim/world/grasps.hpp"
#include "sim/world/imus.hpp"
#include "sim/world/outside_ecus.hpp"
#include "sim/world/virtual_ecus.hpp"
#include "sim/world/world.hpp"

/// The simulator as a device on the bus: the world of robot.xml, and in it the virtual ECUs that
/// run the firmware. Each 2 ms it measures, publishes an ecu_frame and moves on under the commands
/// it has.
///
///   realtime   ticks by the clock; up to 0.2 s behind it catches up at twice the rate, what is
///              further behind is left out and counted as overruns
///   lockstep   a tick follows the command that answers the last frame, as fast as that comes
///
/// With `bus` set it is the robot behind its CAN buses instead, and a gateway is the device. With
/// `converter_port` or `converter_lines` set its ECUs are other programs, on those buses
/// (outside_ecus.hpp).
namespace sim {

class SimNode {
 public:
  struct Lock {
    static constexpr auto element = "lock";
    xml::Place place;
    std::string joint;
    void visit(auto& v) { v.required("joint", joint); }
  };
  struct Params {
    double physics_Hz = 1000;  ///< a multiple of the ECUs' 500 Hz, or std::invalid_argument
    int seed = 1;              ///< of the sensors' noise
    std::string bus;  ///< "": ECUs speak DDS; otherwise CAN frames, on erp::open_buses of this
    int converter_port = 0;  ///< ECUs outside come by datagrams to this port of loopback; 0: none
    std::string converter_lines;  ///< and over these serial devices; with neither they are in here
    std::vector<Lock> locks;      ///< joints held still
    std::vector<Mishap> mishaps;  ///< what breaks, and when
    std::vector<Grasp> grasps;    ///< what is taken up, and when
    bool ecus_outside() const { return converter_port > 0 || !converter_lines.empty(); }
    void visit(auto& v) {
      v("physics_Hz", physics_Hz, xml::Range{500, 20000});
      v("seed", seed, xml::Range{0, 1e9});
      v("bus", bus);
      v("converter_port", converter_port, xml::Range{0, 65535});
      v("converter_lines", converter_lines);
      v.list(locks);
      v.list(mishaps);
      v.list(grasps);
    }
  };

  SimNode(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  void join_bus_as_device();
  void stand_behind(const std::string& bus, const erp::Robot& robot);
  void serve_outside(const Params& params, const erp::Robot& robot);
  void hear_outside();
  void say_outside();
  int steps_a_tick() const;
  void step();
  void tick();
  bool at_end() const { return end_ticks_ && ticks_ >= end_ticks_; }
  void measure_and_say();
  void say_frame();
  void say_again();
  void publish_truth();
  void publish_imus();
  void watch_world();
  void say_once(std::size_t actuator, const std::string& code, const std::string& text);
  void publish_clock(bool finished);
  void on_command(const erp::EcuCommand& command);

  node::Node& node_;
  World world_;
  Mishaps mishaps_;
  Grasps grasps_;
  VirtualEcus ecus_;
  std::unique_ptr<OutsideEcus> outside_;                ///< null: the ECUs are in here
  int alive_said_ = 0;                                  ///< ECUs outside
  std::set<std::pair<std::size_t, std::string>> said_;  ///< of which actuator, what
  Imus imus_;
  std::unique_ptr<BusFront> bus_;  ///< null: the ECUs speak DDS
  node::Publisher<erp::EcuFrame>* frame_out_ = nullptr;
  node::Publisher<erp::JointState>& joints_out_;
  node::Publisher<erp::BodyPose>& bodies_out_;
  node::Publisher<erp::Clock>* clock_out_ = nullptr;    ///< null: another is the device
  node::Publisher<erp::ImuFrame>* imus_out_ = nullptr;  ///< null: the robot has none
  node::Subscription<erp::EcuParameter>* parameter_in_ = nullptr;
  erp::EcuFrame frame_;
  erp::JointState joints_;
  erp::BodyPose bodies_;
  erp::ImuFrame imu_frame_;
  std::uint64_t ticks_ = 0, end_ticks_;
  int steps_ = 0;
  std::int64_t began_ns_ = 0, said_ns_ = 0;
};

}  // namespace sim
