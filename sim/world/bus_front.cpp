#include "sim/world/bus_front.hpp"

#include <array>

namespace sim {

BusFront::BusFront(const std::string& bus, const erp::Robot& robot, VirtualEcus& ecus)
    : bus_(erp::open_bus(bus)), ecus_(robot, ecus.channels()) {}

bool BusFront::hear() {
  std::array<erp::CanFrame, 64> frames;
  while (const auto n = bus_->receive(frames, 0))
    for (std::size_t i = 0; i < n; ++i) ecus_.hear(frames[i]);
  return ecus_.answered();
}

void BusFront::say_boot() { bus_->send(ecus_.boot(FRAME_RESET_POWER)); }

}  // namespace sim
