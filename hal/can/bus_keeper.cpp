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

std::span<const BusNotice> BusKeeper::supervise(std::int64_t now_ns) {
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
      return notify(Severity::info, "bus_active", "the bus is error-active again");
    case BusState::warning:
      return notify(Severity::warning, "bus_warning", "error-warning: check cable and terminators");
    case BusState::passive:
      return notify(Severity::warning, "bus_passive", "error-passive: check cable and terminators");
    case BusState::off:
      return notify(Severity::fault, "bus_off",
                    "bus-off: no frame is sent; the ECUs stop after their command timeout");
    case BusState::down:
      return notify(Severity::fault, "bus_down",
                    "the interface is down; bring it up: ip link set … up type can bitrate …");
  }
}

/// No node acknowledges: accepted frames are not sent, or the controller reports missing
/// acknowledgements and no frame is received.
bool BusKeeper::is_stuck(const BusCounters& now, std::int64_t now_ns) {
  const std::uint64_t sent_on_wire = now.sent - bus_->in_flight();
  if (!last_sent_ns_ || sent_on_wire != sent_on_wire_ || bus_->in_flight() == 0)
    last_sent_ns_ = now_ns;
  sent_on_wire_ = sent_on_wire;
  if (now.received != last_counters_.received) unacknowledged_since_ns_.reset();
  else if (now.unacknowledged != last_counters_.unacknowledged && !unacknowledged_since_ns_)
    unacknowledged_since_ns_ = now_ns;
  last_counters_ = now;
  return !now.off() &&
         (now_ns - *last_sent_ns_ >= stuck_ns ||
          (unacknowledged_since_ns_ && now_ns - *unacknowledged_since_ns_ >= stuck_ns));
}

void BusKeeper::notice_stuck(bool stuck) {
  if (stuck && !stuck_)
    notify(Severity::fault, "not_acknowledged",
           "no frame sent for 20 ms; check that the cable is connected and an ECU has power");
  if (!stuck && stuck_) notify(Severity::info, "acknowledged", "frames are sent again");
  stuck_ = stuck;
  if (stuck_) outbox_.drop();
}

void BusKeeper::recover(std::int64_t now_ns) {
  switch (recovery_.step(state_ == BusState::off, now_ns)) {
    case BusRecovery::Action::nothing:
      return;
    case BusRecovery::Action::give_up:
      return notify(Severity::fault, "bus_off_latched",
                    "bus-off after three restarts; restart the gateway to use this bus again");
    case BusRecovery::Action::restart:
      break;
  }
  try {
    bus_->restart();
    notify(Severity::warning, "bus_restarted",
           "restart " + std::to_string(recovery_.restarts()) + " of " +
               std::to_string(BusRecovery::max_restarts));
  } catch (const std::runtime_error& error) {
    notify(Severity::fault, "bus_restart", error.what());
  }
}

}  // namespace erp
