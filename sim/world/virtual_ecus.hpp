#pragma once
#include <span>
#include <vector>

#include "firmware/core/ecu.h"
#include "interfaces/topics.hpp"
#include "sim/world/bus_effects.hpp"
#include "sim/world/converters.hpp"
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

  /// What breaks from now on; lent, or null.
  void suffer(const Mishaps* mishaps) { converters_.suffer(mishaps); }

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
  void keep_measured(double time_s);
  void obey(const erp::EcuCommand& command);
  void report(erp::EcuFrame& frame) const;
  ecu_channel* find(int ecu, int channel);

  Converters converters_;
  std::vector<ecu_channel> firmware_;  ///< one a channel of the converters
  std::vector<ecu_channel*> channel_pointers_;
  std::vector<double> voltage_V_;
  BusEffects bus_;
  bool measured_ = false;

  struct Making;
  explicit VirtualEcus(Making&& making);
};

}  // namespace sim
