#include "components/plant/arbiter.hpp"

#include <algorithm>

namespace plant {

ControllerCommand* Arbiter::find(std::string_view controller) {
  const auto end = commands_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto it = std::find_if(commands_.begin(), end, [&](const ControllerCommand& command) {
    return controller == command.controller;
  });
  return it == end ? nullptr : &*it;
}

bool Arbiter::update(std::string_view controller, std::int32_t priority, erp::Mode mode,
                     double reference, std::int64_t now_ns, std::int64_t stale_ns) {
  ControllerCommand* slot = find(controller);
  if (!slot && count_ < max_controllers) slot = &commands_[count_++];
  if (!slot) {
    const auto stale =
        std::find_if(commands_.begin(), commands_.end(), [&](const ControllerCommand& command) {
          return now_ns - command.received_ns > stale_ns && owner() != command.controller;
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
  int winner_index = -1;
  for (int i = 0; slot(i) < count_; ++i) {
    const ControllerCommand& command = commands_[slot(i)];
    if (now_ns - command.received_ns > stale_ns) continue;
    const bool is_first = winner_index < 0;
    const auto best_priority = is_first ? 0 : commands_[slot(winner_index)].priority;
    if (is_first || command.priority > best_priority ||
        (command.priority == best_priority && i == owner_))
      winner_index = i;
  }
  owner_ = winner_index;
  return winner_index < 0 ? nullptr : &commands_[slot(winner_index)];
}

}  // namespace plant
