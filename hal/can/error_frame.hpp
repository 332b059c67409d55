#pragma once
#include <linux/can.h>
#include <linux/can/error.h>

#include "hal/can/bus.hpp"

namespace erp::can {

/// State of the bus after an error frame of the controller (linux/can/error.h).
inline BusState state_after(const can_frame& error, BusState before) {
  if (error.can_id & CAN_ERR_BUSOFF) return BusState::off;
  if (error.can_id & CAN_ERR_RESTARTED) return BusState::active;
  if (!(error.can_id & CAN_ERR_CRTL) || before == BusState::off) return before;
  const auto has = [&](int bits) { return (error.data[1] & bits) != 0; };
  if (has(CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) return BusState::passive;
  if (has(CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) return BusState::warning;
  return has(CAN_ERR_CRTL_ACTIVE) ? BusState::active : before;
}

}  // namespace erp::can
