#pragma once
#include <span>
#include <stdexcept>
#include <vector>

#include "interfaces/values.hpp"
#include "sim/actuator/ecu_units.hpp"
#include "sim/world/virtual_ecus.hpp"
#include "sim/world/world.hpp"

/// A robot under its ECUs in the simulator, driven tick by tick without a bus.
namespace sim::rehearsal {

/// What an actuator is asked in a tick of the ECUs.
struct Asked {
  erp::Mode mode = erp::Mode::off;
  double reference = 0;  ///< V, m, A or N
};

/// The motion is not finite.
struct Unsound : std::runtime_error {
  Unsound() : runtime_error("the simulated motion is not finite") {}
};

class Puppet {
 public:
  /// Starts at the initial pose, at pretension, ECUs armed with the gains that the plant would give
  /// them for `configured`. Lends the robots. Throws as World does.
  Puppet(const erp::Robot& robot, const erp::Robot& configured, std::uint64_t seed);
  explicit Puppet(const erp::Robot& robot, std::uint64_t seed = 1) : Puppet(robot, robot, seed) {}

  /// One tick of the ECUs, 2 ms, asked so much by actuator. Throws Unsound.
  void tick(std::span<const Asked> asked);

  const World& world() const { return world_; }
  /// What an actuator's ECU said after the last tick.
  const erp::EcuChannelSample& said_of(std::size_t actuator) const;
  const erp::EcuFrame& frame() const { return frame_; }
  const EcuUnits& units(std::size_t actuator) const { return units_[actuator]; }

 private:
  void give_gains(const erp::Robot& configured);
  void send(std::span<const Asked> asked);

  const erp::Robot& robot_;
  World world_;
  VirtualEcus ecus_;
  std::vector<EcuUnits> units_;
  erp::EcuFrame frame_;
};

}  // namespace sim::rehearsal
