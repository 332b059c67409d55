#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "components/node/node.hpp"
#include "components/sim/bus_front.hpp"
#include "interfaces/robot/robot.hpp"
#include "sim/world/attached_loads.hpp"
#include "sim/world/external_ecus.hpp"
#include "sim/world/imus.hpp"
#include "sim/world/virtual_ecus.hpp"
#include "sim/world/world.hpp"

/// The simulator as the device of a graph: the world of robot.xml with the virtual ECUs that run
/// the firmware. Every 2 ms it measures, publishes an ecu_frame and simulates a tick with the
/// commands received so far.
///
///   realtime   one tick per 2 ms of the clock; after a delay of up to 0.2 s ticks run at
///              twice the rate; a longer delay is skipped and counted as overruns
///   lockstep   a tick follows as soon as the command that answers the last frame arrives
///
/// With `bus` set it simulates the robot on its CAN buses instead, and a gateway is the device.
/// With `converter_port` or `converter_lines` set its ECUs are separate programs on those buses
/// (external_ecus.hpp).
namespace sim {

/// What the virtual ECUs know of the zeros of their encoders at the start.
enum class Zeros { known, unknown };

class SimNode {
 public:
  struct Lock {
    static constexpr auto element = "lock";
    static constexpr auto description = "Joint that does not move.";
    xml::Place place;
    std::string joint;
    void visit(auto& v) {
      v.required("joint", joint, "Joint that is locked at its initial angle.");
    }
  };
  struct Params {
    double physics_Hz = 1000;
    int seed = 1;
    Zeros zeros = Zeros::known;
    std::string bus;
    int converter_port = 0;
    std::string converter_lines;
    std::vector<Lock> locks;
    std::vector<InjectedFault> faults;
    std::vector<AttachedLoad> loads;
    bool has_external_ecus() const { return converter_port > 0 || !converter_lines.empty(); }
    void visit(auto& v) {
      v("physics_Hz", physics_Hz,
        {xml::Range{500, 20000}, "Rate of the physics; a multiple of the ECUs' 500 Hz."});
      v("seed", seed, {xml::Range{0, 1e9}, "Seed of the sensor noise."});
      v("zeros", zeros,
        "Zeros of the encoders at the start. unknown: as after a reset of the ECUs, like those of "
        "a "
        "real robot.");
      v("bus", bus, "CAN buses on which the robot is simulated, as bus of gateway; empty: DDS.");
      v("converter_port", converter_port,
        {xml::Range{0, 65535}, "UDP port on loopback to which external ECUs connect; 0: none."});
      v("converter_lines", converter_lines,
        "Serial devices of external ECUs; empty, and converter_port 0: virtual ECUs.");
      v.list(locks);
      v.list(faults);
      v.list(loads);
    }
  };

  /// Behind a gateway, the gateway is the device.
  static const char* role(const Params& params) {
    return params.bus.empty() && !params.has_external_ecus() ? node::device_role : "";
  }
  SimNode(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  void join_bus_as_device();
  void open_bus_front(const std::string& bus, const erp::Robot& robot);
  void serve_external(const Params& params, const erp::Robot& robot);
  void receive_external();
  void report_external();
  int steps_per_tick() const;
  void step();
  void tick();
  void begin_faults();
  bool at_end() const { return end_ticks_ && ticks_ >= end_ticks_; }
  void measure_and_publish();
  void publish_frame();
  void repeat_frame();
  void publish_truth();
  void publish_imus();
  void check_world();
  void report_once(std::size_t actuator, const std::string& code, const std::string& text);
  void publish_clock(bool finished);
  void on_command(const erp::EcuCommand& command);

  node::Node& node_;
  World world_;
  FaultInjection faults_;
  AttachedLoads loads_;
  VirtualEcus ecus_;
  std::unique_ptr<ExternalEcus> external_;  ///< null: virtual ECUs
  int alive_reported_ = 0;                  ///< connected external ECUs, last reported
  std::set<std::pair<std::size_t, std::string>> reported_;  ///< actuator and event code
  Imus imus_;
  std::unique_ptr<BusFront> bus_;  ///< null: the ECUs use DDS
  node::Publisher<erp::EcuFrame>* frame_out_ = nullptr;
  node::Publisher<erp::JointState>& joints_out_;
  node::Publisher<erp::BodyPose>& bodies_out_;
  node::Publisher<erp::Clock>* clock_out_ = nullptr;    ///< null: another component is the device
  node::Publisher<erp::ImuFrame>* imus_out_ = nullptr;  ///< null: the robot has none
  node::Subscription<erp::EcuParameter>* parameter_in_ = nullptr;
  erp::EcuFrame frame_;
  erp::JointState joints_;
  erp::BodyPose bodies_;
  erp::ImuFrame imu_frame_;
  std::uint64_t ticks_ = 0, end_ticks_;
  int steps_ = 0;
  std::int64_t activated_ns_ = 0, published_ns_ = 0;
};

}  // namespace sim

template <>
struct xml::Names<sim::Zeros> {
  static constexpr auto list = std::to_array<std::pair<const char*, sim::Zeros>>(
      {{"known", sim::Zeros::known}, {"unknown", sim::Zeros::unknown}});
};
