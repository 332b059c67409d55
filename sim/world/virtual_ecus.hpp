#pragma once
#include <span>
#include <vector>

#include "firmware/core/ecu.h"
#include "interfaces/topics.hpp"
#include "sim/world/bus_effects.hpp"
#include "sim/world/converters.hpp"
#include "sim/world/world.hpp"

/// The ECUs of a simulated robot: firmware/core on one channel per actuator, between the world's
/// sensors and its motors. Needs no wall clock and no middleware. A tick is 2 ms of the world's time.
///
///   measure -> counts -> ecu_tick -> duty -> V = duty / 1023 · supply, constant over the tick ->
///   measure
///
/// World::save does not contain the state of ECUs and sensors.
///
/// The effects of robot.xml on sensors and on the bus act here.
///
/// A duty of 0 applies 0 V: the motor is shorted and brakes, as at the H-bridge of the ECU.
namespace sim {

struct VirtualEcuOptions {
  int substeps = 2;        ///< physics steps per tick; 2: 1 kHz
  std::uint64_t seed = 1;  ///< of sensor noise and bus effects; each derives its own from it
  /// The ECUs know the zeros of their encoders at the start, where the lines are as in robot.xml.
  bool zeros_known = true;
};

class VirtualEcus {
 public:
  /// Throws like effects::equip, and std::invalid_argument for less than one substep and for a
  /// sensor on an unknown joint or actuator.
  explicit VirtualEcus(const erp::Robot& robot, const VirtualEcuOptions& options = {});
  VirtualEcus(const VirtualEcus&) = delete;
  VirtualEcus& operator=(const VirtualEcus&) = delete;

  /// Faults to inject from now on; null: none. Not owned.
  void inject(const FaultInjection* faults) { converters_.inject(faults); }

  /// Resets an ECU, like a brown-out: boot, no gains, its encoders count from 0 at the present position.
  void reset(int ecu);

  /// Messages from the bus. Channels that the robot does not have are ignored.
  void receive(const erp::EcuCommand& command);
  void receive(const erp::EcuParameter& parameters);

  /// Reads all converters. Needed only before the first frame, because `tick` also reads them.
  void measure(const World& world);
  /// One control period: runs the firmware on the last measurement, advances the world, measures.
  void tick(World& world);
  /// The last measurement and the duty applied up to it; with bus effects, the newest frame that
  /// the bus has delivered. Sets channels and analogs only.
  void fill(erp::EcuFrame& frame) const;

  /// In robot.xml's order of actuators; valid during the lifetime of this object.
  std::span<ecu_channel* const> channels() { return channel_pointers_; }

 private:
  void send_measured(double time_s);
  void apply(const erp::EcuCommand& command);
  void report(erp::EcuFrame& frame) const;
  ecu_channel* find(int ecu, int channel);

  Converters converters_;
  std::vector<ecu_channel> firmware_;  ///< one per channel of the converters
  std::vector<ecu_channel*> channel_pointers_;
  std::vector<double> voltage_V_;
  BusEffects bus_;
  bool measured_ = false;

  struct Setup;
  explicit VirtualEcus(Setup&& setup);
};

}  // namespace sim
