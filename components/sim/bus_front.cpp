#include "components/sim/bus_front.hpp"

#include <array>

namespace sim {

BusFront::BusFront(const std::string& where, const erp::Robot& robot, VirtualEcus& ecus)
    : routes_(robot), buses_(erp::open_buses(robot, where)), ecus_(robot, ecus.channels()) {}

bool BusFront::receive(std::size_t bus) {
  std::array<erp::CanFrame, 64> frames;
  while (const auto n = buses_[bus]->receive(frames, 0))
    for (std::size_t i = 0; i < n; ++i) ecus_.receive(frames[i]);
  return ecus_.answered();
}

void BusFront::send(std::span<const erp::CanFrame> frames) {
  if (buses_.size() == 1) return void(buses_[0]->send(frames));
  routes_.sort(frames);
  for (std::size_t k = 0; k < buses_.size(); ++k) buses_[k]->send(routes_.on(k));
}

}  // namespace sim
