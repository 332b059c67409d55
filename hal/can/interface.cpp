#include "hal/can/interface.hpp"

#include <libsocketcan.h>

#include <stdexcept>

namespace erp::can {

std::optional<double> bitrate_per_s(const std::string& interface) {
  can_bittiming timing{};
  if (can_get_bittiming(interface.c_str(), &timing) != 0 || timing.bitrate == 0) return {};
  return timing.bitrate;
}

void restart_interface(const std::string& interface) {
  const char* name = interface.c_str();
  if (can_do_restart(name) == 0) return;
  if (can_do_stop(name) == 0 && can_do_start(name) == 0) return;
  throw std::runtime_error("cannot restart interface \"" + interface +
                           "\": permit it (`setcap cap_net_admin+ep` on the gateway program) "
                           "or restart it by hand: `ip link set " +
                           interface + " down`, then up");
}

}  // namespace erp::can
