#include <arpa/inet.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <map>

#include "hal/can/robot_buses.hpp"
#include "hal/ecu/power.hpp"
#include "interfaces/robot/robot.hpp"

// ecu: a robot's ECUs as processes of this machine, on the robot's buses, with the converters of a
// simulated robot.
namespace {

struct Request {
  std::string robot, bus = erp::default_bus(), converters = "127.0.0.1:21000";
  std::vector<int> only;
};

sockaddr_in address_of(const std::string& text) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  const auto colon = text.rfind(':');
  const int port = colon == std::string::npos ? 0 : std::atoi(text.c_str() + colon + 1);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  if (port < 1 || port > 65535 ||
      ::inet_pton(AF_INET, text.substr(0, colon).c_str(), &address.sin_addr) != 1)
    throw std::invalid_argument("--converters " + text +
                                ": give ADDRESS:PORT, for example 127.0.0.1:21000");
  return address;
}

std::map<int, board_fitted> fitted_on(const erp::Robot& robot) {
  std::map<int, board_fitted> ecus;
  for (const erp::Actuator& a : robot.actuators)
    ecus[a.ecu].channels |= static_cast<std::uint8_t>(1 << a.channel);
  for (const erp::AnalogInput& input : robot.analog_inputs())
    ecus[input.ecu].analog_inputs |= static_cast<std::uint8_t>(1 << input.input);
  for (auto& [address, ecu] : ecus) {
    ecu.ecu = static_cast<std::uint8_t>(address);
    ecu.serial = static_cast<std::uint32_t>(address + 1);
  }
  return ecus;
}

board::Rack rack_of(const Request& request) {
  const erp::Robot robot = erp::read_robot(request.robot);
  const auto plans = robot.buses();
  const auto words = erp::bus_specifications(request.bus, plans.size());
  const erp::BusRoutes routes(robot);
  const sockaddr_in converters = address_of(request.converters);
  board::Rack rack;
  for (const auto& [address, fitted] : fitted_on(robot)) {
    if (!request.only.empty() && std::ranges::find(request.only, address) == request.only.end())
      continue;
    const std::size_t bus = routes.bus_of(address);
    board::Place place{words[bus], {}, converters};
    place.bus_options.fd = plans[bus].data_bitrate_per_s.has_value();
    rack.slots.push_back({fitted, place});
  }
  if (rack.slots.empty()) throw std::invalid_argument(request.robot + " has no such ECU");
  return rack;
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  CLI::App app(
      "The ECUs of a robot, as processes that run the firmware.\n\n"
      "Each joins its CAN bus; its converters are those of a simulated robot\n"
      "(sim with converter_port). Kill one, and it comes back as after a brown-out.",
      "ecu");
  app.add_option("--robot", request.robot, "robot.xml")->required();
  app.add_option("--bus", request.bus,
                 "socketcan:IFACE, udp:GROUP:PORT; for several buses one each")
      ->capture_default_str();
  app.add_option("--converters", request.converters, "where the simulated robot listens")
      ->capture_default_str();
  app.add_option("--only", request.only, "addresses; default: all ECUs of the robot");
  CLI11_PARSE(app, argc, argv);
  try {
    return board::run_rack(rack_of(request));
  } catch (const std::exception& error) {
    std::cerr << "ecu: " << error.what() << '\n';
    return 2;
  }
}
