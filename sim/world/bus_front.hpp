#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "hal/can/bus.hpp"
#include "hal/can/robot_ecus.hpp"
#include "sim/world/virtual_ecus.hpp"

/// The simulated robot behind a CAN bus: the virtual ECUs speak frames instead of DDS.
namespace sim {

class BusFront {
 public:
  /// Throws std::runtime_error when the bus cannot be opened.
  BusFront(const std::string& bus, const erp::Robot& robot, VirtualEcus& ecus);

  int descriptor() const { return bus_->fd(); }
  /// Takes everything that waits on the bus. True when every ECU has its answer to the last tick.
  bool hear();
  void say_boot();
  void say(const erp::EcuFrame& tick) { bus_->send(ecus_.report(tick)); }
  void say_again() { bus_->send(ecus_.again()); }

 private:
  std::unique_ptr<erp::CanBus> bus_;
  erp::RobotEcus ecus_;
};

}  // namespace sim
