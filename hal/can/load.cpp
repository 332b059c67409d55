#include "hal/can/load.hpp"

#include <array>
#include <cmath>
#include <map>

#include "firmware/core/bundle.h"
#include "firmware/core/link.h"
#include "interfaces/xml/errors.hpp"

namespace erp {
namespace {

constexpr double period_s = 0.002;  // of the ECUs

/// Frames that one ECU sends in a period.
struct EcuFrames {
  int channels = 0;
  std::array<bool, 2> analog_page{};
  int frames() const { return channels + analog_page[0] + analog_page[1]; }
};

std::map<int, EcuFrames> frames_by_ecu(const Robot& robot) {
  std::map<int, EcuFrames> ecus;
  for (const Actuator& actuator : robot.actuators) ++ecus[actuator.ecu].channels;
  for (const AnalogInput& input : robot.analog_inputs())
    ecus[input.ecu].analog_page[static_cast<std::size_t>(input.input / 2)] = true;
  return ecus;
}

double bundles_time_s(int frames, const BusPlan& bus) {
  double time_s = 0;
  for (int remaining = frames; remaining > 0; remaining -= static_cast<int>(BUNDLE_FRAMES_MAX))
    time_s += fd_frame_time_s(bundle_size(static_cast<unsigned>(remaining)), bus.bitrate_per_s,
                              *bus.data_bitrate_per_s);
  return time_s;
}

/// Time for several frames: one after the other, or in bundles.
double time_s(int frames, const BusPlan& bus) {
  if (bus.data_bitrate_per_s) return bundles_time_s(frames, bus);
  return frames * frame_time_s(8, bus.bitrate_per_s);
}

BusLoad load_of(const BusPlan& bus, const std::map<int, EcuFrames>& ecus) {
  constexpr double health_fraction = 1.0 / ECU_HEALTH_TICKS;
  BusLoad load{bus.name, static_cast<int>(bus.ecus.size())};
  load.period_s = time_s(load.ecus, bus);
  for (const int ecu : bus.ecus) {
    const auto sender = ecus.find(ecu);
    if (sender == ecus.end()) continue;
    const int frames = sender->second.frames();
    load.period_s +=
        time_s(frames, bus) * (1 - health_fraction) + time_s(frames + 1, bus) * health_fraction;
  }
  load.share = load.period_s / period_s;
  return load;
}

std::string percent(double fraction) { return std::to_string(std::lround(100 * fraction)) + " %"; }

}  // namespace

double frame_time_s(std::size_t bytes, double bitrate_per_s) {
  const std::size_t stuffed = 34 + 8 * bytes;
  return static_cast<double>(stuffed + 13 + (stuffed - 1) / 4) / bitrate_per_s;
}

double fd_frame_time_s(std::size_t bytes, double bitrate_per_s, double data_bitrate_per_s) {
  constexpr std::size_t arbitration = 17 + 16 / 4 + 13;
  const std::size_t stuffed = 5 + 8 * bytes;
  const std::size_t check = bytes > 16 ? 4 + 21 + 7 : 4 + 17 + 6;
  const std::size_t data = stuffed + stuffed / 4 + check;
  return arbitration / bitrate_per_s + static_cast<double>(data) / data_bitrate_per_s;
}

std::vector<BusLoad> bus_loads(const Robot& robot) {
  const auto ecus = frames_by_ecu(robot);
  std::vector<BusLoad> loads;
  for (const BusPlan& bus : robot.buses()) loads.push_back(load_of(bus, ecus));
  return loads;
}

std::string to_string(const BusLoad& load) {
  return load.bus + ": " + std::to_string(load.ecus) + (load.ecus == 1 ? " ECU, " : " ECUs, ") +
         percent(load.share) + " of its time";
}

void refuse_overload(const Robot& robot) {
  if (robot.can_buses.empty()) return;
  std::vector<xml::Error> errors;
  const auto loads = bus_loads(robot);
  for (std::size_t i = 0; i < loads.size(); ++i)
    if (loads[i].share > max_load)
      errors.push_back(
          xml::error_in(BusPlan::element, robot.can_buses[i].place,
                        "bus \"" + loads[i].bus + "\" would be busy " + percent(loads[i].share) +
                            " of its time, more than " + percent(max_load),
                        "spread its " + std::to_string(loads[i].ecus) +
                            " ECUs over more buses, or give it CAN FD: data_bitrate_per_s"));
  xml::throw_if_any(std::move(errors));
}

}  // namespace erp
