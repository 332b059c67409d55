#pragma once
#include <span>
#include <stdexcept>
#include <vector>

#include "interfaces/values.hpp"
#include "sim/model/actuator/ecu_units.hpp"
#include "sim/world/virtual_ecus.hpp"
#include "sim/world/world.hpp"

/// A robot and its ECUs in the simulator, driven tick by tick without a bus.
namespace sim {

/// The set-point of an actuator for one tick of the ECUs.
struct SetPoint {
  erp::Mode mode = erp::Mode::off;
  double reference = 0;  ///< V, m, A or N
};

/// Error: the motion is not finite.
struct NotFinite : std::runtime_error {
  NotFinite() : runtime_error("the simulated motion is not finite") {}
};

class SimulatedRobot {
 public:
  /// Starts at the initial pose and at pretension. The ECUs are armed and have the gains that the
  /// plant would send for `configured`. Keeps references to the robots. Throws like World.
  SimulatedRobot(const erp::Robot& robot, const erp::Robot& configured, std::uint64_t seed);
  explicit SimulatedRobot(const erp::Robot& robot, std::uint64_t seed = 1)
      : SimulatedRobot(robot, robot, seed) {}

  /// One tick of the ECUs, 2 ms; one set-point per actuator. Throws NotFinite.
  void tick(std::span<const SetPoint> set_points);

  const World& world() const { return world_; }
  /// An ECU channel after the last tick.
  const erp::EcuChannelSample& sample_of(std::size_t actuator) const;
  const erp::EcuFrame& frame() const { return frame_; }
  const EcuUnits& units(std::size_t actuator) const { return units_[actuator]; }

 private:
  void send_gains(const erp::Robot& configured);
  void send(std::span<const SetPoint> set_points);

  const erp::Robot& robot_;
  World world_;
  VirtualEcus ecus_;
  std::vector<EcuUnits> units_;
  erp::EcuFrame frame_;
};

}  // namespace sim
