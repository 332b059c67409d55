#include "components/plant/arbiter.hpp"

#include <algorithm>

namespace plant {

ControllerCommand* Arbiter::find(std::string_view controller) {
  const auto end = commands_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto it = std::find_if(commands_.begin(), end, [&](const ControllerCommand& o) {
    return controller == o.controller;
  });
  return it == end ? nullptr : &*it;
}

bool Arbiter::update(std::string_view controller, std::int32_t priority, erp::Mode mode,
                     double reference, std::int64_t now_ns, std::int64_t stale_ns) {
  ControllerCommand* slot = find(controller);
  if (!slot && count_ < max_controllers) slot = &commands_[count_++];
  if (!slot) {
    const auto stale =
        std::find_if(commands_.begin(), commands_.end(), [&](const ControllerCommand& o) {
          return now_ns - o.received_ns > stale_ns && owner() != o.controller;
        });
    if (stale == commands_.end()) return false;
    slot = &*stale;
  }
  const auto size = std::min(controller.size(), sizeof slot->controller - 1);
  std::copy_n(controller.data(), size, slot->controller);
  slot->controller[size] = '\0';
  slot->priority = priority;
  slot->mode = mode;
  slot->reference = reference;
  slot->received_ns = now_ns;
  return true;
}

const ControllerCommand* Arbiter::winner(std::int64_t now_ns, std::int64_t stale_ns) {
  int best = -1;
  for (int i = 0; slot(i) < count_; ++i) {
    const ControllerCommand& command = commands_[slot(i)];
    if (now_ns - command.received_ns > stale_ns) continue;
    const bool first = best < 0;
    const auto other = first ? 0 : commands_[slot(best)].priority;
    if (first || command.priority > other || (command.priority == other && i == owner_)) best = i;
  }
  owner_ = best;
  return best < 0 ? nullptr : &commands_[slot(best)];
}

}  // namespace plant
