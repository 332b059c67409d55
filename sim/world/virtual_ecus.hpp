#pragma once
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "firmware/core/ecu.h"
#include "interfaces/topics.hpp"
#include "sim/actuator/sampling.hpp"
#include "sim/actuator/sensors.hpp"
#include "sim/world/bus_effects.hpp"
#include "sim/world/world.hpp"

/// The ECUs of a simulated robot: firmware/core on one channel an actuator, between the world's
/// sensors and its motors. Pure: no clock, no bus; a tick is 2 ms of the world's time.
///
///   measure -> counts -> ecu_tick -> duty -> V = duty / 1023 · supply, held over the tick ->
///   measure
///
/// What ECUs and sensors remember is theirs: a World's `save` does not hold it.
///
/// Effects of the robot on its sensors and its bus act here.
///
/// A duty of 0 shorts the motor (it brakes), as the H-bridge of the ECU does.
namespace sim {

struct VirtualEcuOptions {
  int substeps = 2;        ///< physics steps a tick: 2 is 1 kHz
  std::uint64_t seed = 1;  ///< of the sensors' noise; each sensor draws its own from it
};

class VirtualEcus {
 public:
  /// Throws as effects::equip, and std::invalid_argument: no substep, a sensor on a joint or
  /// actuator there is not.
  explicit VirtualEcus(const erp::Robot& robot, const VirtualEcuOptions& options = {});
  VirtualEcus(const VirtualEcus&) = delete;
  VirtualEcus& operator=(const VirtualEcus&) = delete;

  /// What a bus delivers. Channels the robot does not have are ignored.
  void accept(const erp::EcuCommand& command);
  void accept(const erp::EcuParameter& parameters);

  /// Reads all converters; `tick` does so by itself, this is for the first frame.
  void measure(const World& world);
  /// One control period: the firmware on the last measurement, the world on, a new measurement.
  void tick(World& world);
  /// The last measurement, with the duty that was applied up to it. Sets channels and analogs only.
  void fill(erp::EcuFrame& frame) const;

  /// In robot.xml's order of actuators; valid as long as this lives.
  std::span<ecu_channel* const> channels() { return channel_pointers_; }

 private:
  struct Channel {
    int ecu, number;
    double supply_V;
    ActuatorSensors sensors;
    Sampled<ActuatorCounts> readings;
    ActuatorCounts counts;
    ecu_channel firmware;
    std::optional<std::size_t> wiper = {};  ///< which analog input is its potentiometer
  };
  /// An analog input: a joint's angle or an actuator's potentiometer.
  struct Analog {
    int ecu, input;
    std::size_t source;  ///< which joint, or which actuator
    std::variant<JointAngleSensor, PotentiometerSensor> sensor;
    Sampled<std::int32_t> readings;
    std::int32_t counts;
  };
  using Effects = std::span<const effects::Placed>;
  void add_channels(const erp::Robot& robot, Effects acting, std::uint64_t& seed);
  void add_analogs(const erp::Robot& robot, Effects acting, std::uint64_t& seed);
  void obey(const erp::EcuCommand& command);
  void report(erp::EcuFrame& frame) const;
  void look(const World& world, bool all);
  Channel* find(int ecu, int channel);

  VirtualEcuOptions options_;
  std::vector<Channel> channels_;
  std::vector<Analog> analogs_;
  std::vector<ecu_channel*> channel_pointers_;
  std::vector<double> voltage_V_;
  BusEffects bus_;
  bool measured_ = false;
};

}  // namespace sim
