#pragma once
#include <optional>
#include <string>

/// Control of a CAN network interface over netlink (libsocketcan); inside hal/can only.
namespace erp::can {

/// Nominal bit rate; empty for an interface without one, such as a virtual one.
std::optional<double> bitrate_per_s(const std::string& interface);

/// Ends bus-off: restarts the controller or, if the driver refuses that (slcan), takes the interface
/// down and up again, which a bound socket survives. Frames in the kernel's queue are lost.
/// Throws std::runtime_error, usually because CAP_NET_ADMIN is missing.
void restart_interface(const std::string& interface);

}  // namespace erp::can
