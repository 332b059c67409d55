#include "hal/can/outbox.hpp"

#include <algorithm>

namespace erp {

Outbox::Outbox() {
  commands_.reserve(FRAME_ECUS);
  to_send_.reserve(FRAME_ECUS);
  others_.reserve(max_others);
}

void Outbox::put(std::span<const CanFrame> frames, std::int64_t now_ns) {
  for (const CanFrame& frame : frames) {
    const bool may_overtake = now_ns != 0 && frame_function_of(&frame) == FRAME_COMMAND;
    if (may_overtake) put_command(frame, now_ns);
    else if (others_.size() < max_others) others_.push_back(frame);
    else ++dropped_;
  }
}

void Outbox::put_command(const CanFrame& frame, std::int64_t now_ns) {
  const auto queued = std::ranges::find(
      commands_, frame.id, [](const QueuedCommand& command) { return command.frame.id; });
  if (queued == commands_.end()) commands_.push_back({frame, now_ns});
  else *queued = {frame, now_ns}, ++replaced_;
}

void Outbox::drop_expired(std::int64_t now_ns) {
  expired_ += std::erase_if(commands_, [&](const QueuedCommand& command) {
    return now_ns - command.since_ns > max_age_ns;
  });
}

void Outbox::flush(CanBus& bus, std::int64_t now_ns) {
  drop_expired(now_ns);
  if (flush_commands(bus)) flush_others(bus);
}

/// Returns true when all COMMANDs have been sent.
bool Outbox::flush_commands(CanBus& bus) {
  if (commands_.empty()) return true;
  to_send_.clear();
  for (const QueuedCommand& queued : commands_) to_send_.push_back(queued.frame);
  const auto accepted = static_cast<std::ptrdiff_t>(bus.send(to_send_));
  commands_.erase(commands_.begin(), commands_.begin() + accepted);
  return commands_.empty();
}

void Outbox::flush_others(CanBus& bus) {
  if (others_.empty()) return;
  const auto accepted = static_cast<std::ptrdiff_t>(bus.send(others_));
  others_.erase(others_.begin(), others_.begin() + accepted);
}

void Outbox::drop() {
  expired_ += commands_.size();
  dropped_ += others_.size();
  commands_.clear();
  others_.clear();
}

}  // namespace erp
