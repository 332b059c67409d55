#include <array>
#include <charconv>
#include <cstdlib>

#include "hal/can/backends.hpp"

namespace erp {
namespace {

constexpr auto usage =
    "write socketcan:INTERFACE (e.g. socketcan:can0), udp:GROUP:PORT (e.g. "
    "udp:239.255.42.1:20000) or trace:FILE";

int port_of(const std::string& text) {
  int port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (!is_number || port < 1 || port > 65535)
    throw std::invalid_argument("port \"" + text + "\" is not a number from 1 to 65535; " + usage);
  return port;
}

std::unique_ptr<CanBus> open_by_name(const std::string& specification, const BusOptions& options) {
  const auto colon = specification.find(':');
  const std::string backend = specification.substr(0, colon);
  const std::string parameters = colon == std::string::npos ? "" : specification.substr(colon + 1);
  if (backend == "socketcan") {
    if (parameters.empty())
      throw std::invalid_argument(std::string("names no interface; ") + usage);
    return can::open_socketcan(parameters, options);
  }
  if (backend == "udp") {
    const auto last_colon = parameters.rfind(':');
    if (last_colon == std::string::npos)
      throw std::invalid_argument(std::string("names no group and port; ") + usage);
    return can::open_udp(parameters.substr(0, last_colon),
                         port_of(parameters.substr(last_colon + 1)));
  }
  if (backend == "trace") return can::open_trace(parameters);
  throw std::invalid_argument("unknown back end \"" + backend + "\"; " + usage);
}

constexpr int first_port = 20000, ports_per_domain = 16;  // chosen

}  // namespace

std::string default_bus() {
  const char* domain = std::getenv("ERP_DOMAIN");
  const int port = first_port + ports_per_domain * (domain ? std::atoi(domain) : 0);
  return "udp:239.255.42.1:" + std::to_string(port);
}

const char* name_of(BusState state) {
  static constexpr std::array names{"active", "warning", "passive", "bus-off", "down"};
  return names[static_cast<std::size_t>(state)];
}

std::unique_ptr<CanBus> open_bus(const std::string& specification, const BusOptions& options) {
  const std::string place = "CAN bus \"" + specification + "\": ";
  try {
    return open_by_name(specification, options);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(place + error.what());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(place + error.what());
  }
}

}  // namespace erp
