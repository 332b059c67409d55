#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/can/robot_buses.hpp"
#include "hal/can/robot_ecus.hpp"
#include "sim/world/virtual_ecus.hpp"

/// The simulated robot on its CAN buses: the virtual ECUs exchange frames instead of DDS messages.
namespace sim {

class BusFront {
 public:
  /// `where` as in erp::open_buses; throws as that function.
  BusFront(const std::string& where, const erp::Robot& robot, VirtualEcus& ecus);

  std::size_t buses() const { return buses_.size(); }
  int descriptor(std::size_t bus) const { return buses_[bus]->fd(); }
  /// Receives all waiting frames of a bus. True when every ECU has its answer to the last tick.
  bool receive(std::size_t bus);
  void send_boot() { send(ecus_.boot(FRAME_RESET_POWER)); }
  /// The ECU's link starts again, with its boot frame.
  void reset(int ecu) { send(ecus_.reset(ecu, FRAME_RESET_BROWN_OUT)); }
  void send_tick(const erp::EcuFrame& tick) { send(ecus_.report(tick)); }
  void repeat_tick() { send(ecus_.repeat()); }

 private:
  void send(std::span<const erp::CanFrame> frames);

  erp::BusRoutes routes_;
  std::vector<std::unique_ptr<erp::CanBus>> buses_;
  erp::RobotEcus ecus_;
};

}  // namespace sim
