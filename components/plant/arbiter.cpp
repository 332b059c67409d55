#include "components/plant/arbiter.hpp"

#include <algorithm>

namespace plant {

Offer* Arbiter::find(std::string_view controller) {
  const auto end = offers_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto it = std::find_if(offers_.begin(), end,
                               [&](const Offer& o) { return controller == o.controller; });
  return it == end ? nullptr : &*it;
}

bool Arbiter::offer(std::string_view controller, std::int32_t priority, erp::Mode mode,
                    double reference, std::int64_t now_ns, std::int64_t stale_ns) {
  Offer* slot = find(controller);
  if (!slot && count_ < max_controllers) slot = &offers_[count_++];
  if (!slot) {
    const auto stale = std::find_if(offers_.begin(), offers_.end(), [&](const Offer& o) {
      return now_ns - o.received_ns > stale_ns && owner() != o.controller;
    });
    if (stale == offers_.end()) return false;
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

const Offer* Arbiter::winner(std::int64_t now_ns, std::int64_t stale_ns) {
  int best = -1;
  for (int i = 0; slot(i) < count_; ++i) {
    const Offer& offer = offers_[slot(i)];
    if (now_ns - offer.received_ns > stale_ns) continue;
    const bool first = best < 0;
    const auto other = first ? 0 : offers_[slot(best)].priority;
    if (first || offer.priority > other || (offer.priority == other && i == owner_)) best = i;
  }
  owner_ = best;
  return best < 0 ? nullptr : &offers_[slot(best)];
}

}  // namespace plant
