#include "hal/can/bus_keeper.hpp"

#include <stdexcept>

namespace erp {

void BusKeeper::record(const std::string& file) {
  trace_ = std::make_unique<TraceWriter>(file, name_);
  bus_->record(trace_.get());
}

void BusKeeper::post(std::span<const CanFrame> frames, std::int64_t now_ns) {
  outbox_.put(frames, now_ns);
  if (bus_->counters().state == BusState::off || stuck_) outbox_.drop();
  else outbox_.flush(*bus_, now_ns);
}

std::span<const BusNotice> BusKeeper::mind(std::int64_t now_ns) {
  notices_.clear();
  const BusCounters now = bus_->counters();
  if (now.state != state_) notice_state(now.state);
  if (now.off()) outbox_.drop();
  notice_stuck(is_stuck(now, now_ns));
  if (now.state == BusState::off || recovery_.restarts() > 0) recover(now_ns);
  flush(now_ns);
  return notices_;
}

void BusKeeper::notice_state(BusState state) {
  state_ = state;
  switch (state) {
    case BusState::active:
      return say(Severity::info, "bus_active", "the bus is well again");
    case BusState::warning:
      return say(Severity::warning, "bus_warning", "many errors: look at cable and terminators");
    case BusState::passive:
      return say(Severity::warning, "bus_passive",
                 "so many errors that the controller holds back: look at cable and terminators");
    case BusState::off:
      return say(Severity::fault, "bus_off",
                 "the controller has left the bus; nothing is sent, its ECUs stop by themselves");
    case BusState::down:
      return say(Severity::fault, "bus_down",
                 "the interface is down; bring it up: ip link set … up type can bitrate …");
  }
}

/// Nobody there to acknowledge: frames are taken and never leave, or the controller says so and
/// nothing is heard.
bool BusKeeper::is_stuck(const BusCounters& now, std::int64_t now_ns) {
  const std::uint64_t left = now.sent - bus_->in_flight();
  if (!left_ns_ || left != left_ || bus_->in_flight() == 0) left_ns_ = now_ns;
  left_ = left;
  if (now.received != last_.received) alone_since_ns_.reset();
  else if (now.unacknowledged != last_.unacknowledged && !alone_since_ns_) alone_since_ns_ = now_ns;
  last_ = now;
  return !now.off() && (now_ns - *left_ns_ >= stuck_ns ||
                        (alone_since_ns_ && now_ns - *alone_since_ns_ >= stuck_ns));
}

void BusKeeper::notice_stuck(bool stuck) {
  if (stuck && !stuck_)
    say(Severity::fault, "not_acknowledged",
        "no frame leaves for 20 ms: the cable is open, or no ECU has power");
  if (!stuck && stuck_) say(Severity::info, "acknowledged", "frames leave again");
  stuck_ = stuck;
  if (stuck_) outbox_.drop();
}

void BusKeeper::recover(std::int64_t now_ns) {
  switch (recovery_.step(state_ == BusState::off, now_ns)) {
    case BusRecovery::Do::nothing:
      return;
    case BusRecovery::Do::give_up:
      return say(Severity::fault, "bus_off_latched",
                 "off again after three restarts: it stays off until the gateway is restarted");
    case BusRecovery::Do::restart:
      break;
  }
  try {
    bus_->restart();
    say(Severity::warning, "bus_restarted",
        "restart " + std::to_string(recovery_.restarts()) + " of " +
            std::to_string(BusRecovery::most_restarts));
  } catch (const std::runtime_error& error) {
    say(Severity::fault, "bus_restart", error.what());
  }
}

}  // namespace erp
