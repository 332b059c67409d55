#include "hal/can/outbox.hpp"

#include <algorithm>

namespace erp {

Outbox::Outbox() {
  waiting_.reserve(FRAME_ECUS);
  going_.reserve(FRAME_ECUS);
  others_.reserve(most_others);
}

void Outbox::put(std::span<const CanFrame> frames, std::int64_t now_ns) {
  for (const CanFrame& frame : frames) {
    const bool may_overtake = now_ns != 0 && frame_function_of(&frame) == FRAME_COMMAND;
    if (may_overtake) put_command(frame, now_ns);
    else if (others_.size() < most_others) others_.push_back(frame);
    else ++dropped_;
  }
}

void Outbox::put_command(const CanFrame& frame, std::int64_t now_ns) {
  const auto same =
      std::ranges::find(waiting_, frame.id, [](const Waiting& w) { return w.frame.id; });
  if (same == waiting_.end()) waiting_.push_back({frame, now_ns});
  else *same = {frame, now_ns}, ++replaced_;
}

void Outbox::forget_old(std::int64_t now_ns) {
  expired_ +=
      std::erase_if(waiting_, [&](const Waiting& w) { return now_ns - w.since_ns > max_age_ns; });
}

void Outbox::flush(CanBus& bus, std::int64_t now_ns) {
  forget_old(now_ns);
  if (flush_commands(bus)) flush_others(bus);
}

/// Returns true when no COMMAND is left.
bool Outbox::flush_commands(CanBus& bus) {
  if (waiting_.empty()) return true;
  going_.clear();
  for (const Waiting& w : waiting_) going_.push_back(w.frame);
  const auto taken = static_cast<std::ptrdiff_t>(bus.send(going_));
  waiting_.erase(waiting_.begin(), waiting_.begin() + taken);
  return waiting_.empty();
}

void Outbox::flush_others(CanBus& bus) {
  if (others_.empty()) return;
  const auto taken = static_cast<std::ptrdiff_t>(bus.send(others_));
  others_.erase(others_.begin(), others_.begin() + taken);
}

void Outbox::drop() {
  expired_ += waiting_.size();
  dropped_ += others_.size();
  waiting_.clear();
  others_.clear();
}

}  // namespace erp
