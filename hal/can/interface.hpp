#pragma once
#include <optional>
#include <string>

/// A CAN network interface as a thing of its own, over netlink (libsocketcan); inside hal/can only.
namespace erp::can {

/// Nominal bit rate; nothing for an interface that has none, as virtual ones do.
std::optional<double> bitrate_per_s(const std::string& interface);

/// Ends bus-off: restarts the controller or, where the driver refuses (slcan), takes the interface
/// down and up again, which a bound socket survives. What waited in the kernel's queue is gone.
/// Throws std::runtime_error: usually for want of the right CAP_NET_ADMIN.
void restart_interface(const std::string& interface);

}  // namespace erp::can
