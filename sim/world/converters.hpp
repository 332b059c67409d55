#pragma once
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "firmware/core/sensing.h"
#include "sim/model/actuator/sampling.hpp"
#include "sim/model/actuator/sensors.hpp"
#include "sim/world/mishaps.hpp"
#include "sim/world/world.hpp"

/// What stands between the world and the ECUs: each actuator's encoder, current and tension
/// converters, the analog inputs, and the PWM stages. Which firmware looks at them, and where it
/// runs, is another's.
///
/// Effects of the robot on its sensors act here, and so do mishaps. Pure: no clock.
namespace sim {

class Converters {
 public:
  struct Channel {
    int ecu, number;
    double supply_V;
    ActuatorSensors sensors;
    Sampled<ActuatorCounts> readings;
    ecu_inputs inputs{};                    ///< as the ECU reads them
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

  /// Of a robot with its effects taken out (effects::equip) and these acting. Each sensor draws its
  /// noise from `seed` on, which moves. Throws std::invalid_argument: no substep, a sensor on a
  /// joint or actuator there is not.
  Converters(const erp::Robot& robot, std::span<const effects::Placed> acting, int substeps,
             std::uint64_t& seed);

  /// What befalls sensors and tendons from now on; lent, or null.
  void suffer(const Mishaps* mishaps) { mishaps_ = mishaps; }

  /// Reads all of them.
  void measure(const World& world);
  /// One period of 2 ms under these voltages, one an actuator; then a new measurement.
  void pass_period(World& world, std::span<const double> voltage_V);
  /// The same for another time.
  void pass(World& world, std::span<const double> voltage_V, double duration_s);

  std::span<const Channel> channels() const { return channels_; }
  std::span<const Analog> analogs() const { return analogs_; }

 private:
  void add_channels(const erp::Robot& robot, std::span<const effects::Placed> acting,
                    std::uint64_t& seed);
  void add_analogs(const erp::Robot& robot, std::span<const effects::Placed> acting,
                   std::uint64_t& seed);
  void look(const World& world, bool all);

  int substeps_;
  std::vector<Channel> channels_;
  std::vector<Analog> analogs_;
  const Mishaps* mishaps_ = nullptr;
};

}  // namespace sim
