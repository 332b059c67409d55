#pragma once
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "firmware/core/sensing.h"
#include "sim/model/actuator/sampling.hpp"
#include "sim/model/actuator/sensors.hpp"
#include "sim/world/fault_injection.hpp"
#include "sim/world/world.hpp"

/// The interface between the world and the ECUs: each actuator's encoder, current and tension
/// converters, the analog inputs, and the PWM stages. Independent of the firmware that uses them
/// and of where it runs.
///
/// Effects of the robot on its sensors and injected faults act here. No clock.
namespace sim {

class Converters {
 public:
  struct Channel {
    int ecu, number;
    double supply_V;
    ActuatorSensors sensors;
    Sampled<ActuatorCounts> readings;
    ecu_inputs inputs{};                    ///< as the ECU reads them
    std::int32_t start_counts = 0;          ///< encoder at the last reset of the ECU
    std::optional<std::size_t> wiper = {};  ///< index of the analog input with its potentiometer
  };
  /// An analog input: a joint's angle or an actuator's potentiometer.
  struct Analog {
    int ecu, input;
    std::size_t source;  ///< index of the joint or of the actuator
    std::variant<JointAngleSensor, PotentiometerSensor> sensor;
    Sampled<std::int32_t> readings;
    std::int32_t counts;
  };

  /// `robot`: without the effects `acting`, which effects::equip separates. The noise seed of each
  /// sensor is the incremented `seed`. Throws std::invalid_argument for less than
  /// one substep and for a sensor on an unknown joint or actuator.
  Converters(const erp::Robot& robot, std::span<const effects::Placed> acting, int substeps,
             std::uint64_t& seed);

  /// Faults of sensors and tendons to inject from now on; not owned, or null.
  void inject(const FaultInjection* faults) { faults_ = faults; }

  /// Reads all converters.
  void measure(const World& world);
  /// One period of 2 ms with these voltages, one per actuator; then a new measurement.
  void pass_period(World& world, std::span<const double> voltage_V);
  /// The same for another duration.
  void pass(World& world, std::span<const double> voltage_V, double duration_s);

  /// The encoder of an actuator counts from 0 at its present position.
  void restart_encoder(std::size_t actuator);

  std::span<const Channel> channels() const { return channels_; }
  std::span<const Analog> analogs() const { return analogs_; }

 private:
  void add_channels(const erp::Robot& robot, std::span<const effects::Placed> acting,
                    std::uint64_t& seed);
  void add_analogs(const erp::Robot& robot, std::span<const effects::Placed> acting,
                   std::uint64_t& seed);
  void sample(const World& world, bool all);

  int substeps_;
  std::vector<Channel> channels_;
  std::vector<Analog> analogs_;
  const FaultInjection* faults_ = nullptr;
};

}  // namespace sim
