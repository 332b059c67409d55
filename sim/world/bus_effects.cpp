#include "sim/world/bus_effects.hpp"

#include <algorithm>

namespace sim {

namespace {
constexpr double rounding_s = 1e-9;  // tolerance for rounded times
}

void BusEffects::send(const erp::EcuCommand& command) {
  const auto draw = [this] { return random_.uniform(); };
  if (acting_.loses_command(draw)) return;
  enqueue(commands_, now_s_ + acting_.command_delay_s(draw), command);
}

const erp::EcuCommand* BusEffects::arrived(double time_s) {
  if (commands_.empty() || commands_.front().due_s > time_s + rounding_s) return nullptr;
  current_ = commands_.front().message;
  commands_.pop_front();
  return &current_;
}

void BusEffects::send_frame(const erp::EcuFrame& frame, double time_s) {
  now_s_ = time_s;
  enqueue(frames_, time_s + acting_.frame_delay_s([this] { return random_.uniform(); }), frame);
  while (frames_.size() > 1 && frames_[1].due_s <= time_s + rounding_s) frames_.pop_front();
}

}  // namespace sim
