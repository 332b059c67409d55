#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/can/robot_buses.hpp"
#include "hal/can/robot_ecus.hpp"
#include "sim/world/virtual_ecus.hpp"

/// The simulated robot behind its CAN buses: the virtual ECUs speak frames instead of DDS.
namespace sim {

class BusFront {
 public:
  /// `where` as erp::open_buses takes it, and throws.
  BusFront(const std::string& where, const erp::Robot& robot, VirtualEcus& ecus);

  std::size_t buses() const { return buses_.size(); }
  int descriptor(std::size_t bus) const { return buses_[bus]->fd(); }
  /// Takes everything that waits on a bus. True when every ECU has its answer to the last tick.
  bool hear(std::size_t bus);
  void say_boot() { send(ecus_.boot(FRAME_RESET_POWER)); }
  void say(const erp::EcuFrame& tick) { send(ecus_.report(tick)); }
  void say_again() { send(ecus_.again()); }

 private:
  void send(std::span<const erp::CanFrame> frames);

  erp::BusRoutes routes_;
  std::vector<std::unique_ptr<erp::CanBus>> buses_;
  erp::RobotEcus ecus_;
};

}  // namespace sim
