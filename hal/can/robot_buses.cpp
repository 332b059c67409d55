#include "hal/can/robot_buses.hpp"

#include <cmath>
#include <stdexcept>

#include "hal/can/interface.hpp"
#include "interfaces/xml/values.hpp"
#include "interfaces/xml/words.hpp"

namespace erp {
namespace {

constexpr std::size_t gain_set_frames = 4096;  // chosen: one gain set of a whole robot
constexpr double rate_tolerance = 0.001;       // chosen, relative
constexpr std::string_view kernel_bus = "socketcan:", trace = "trace:";

/// `text` with its last number increased by `add`.
std::string with_increased_number(const std::string& text, std::size_t add) {
  const auto last_digit = text.find_last_of("0123456789");
  if (last_digit == std::string::npos || last_digit + 1 != text.size())
    throw std::invalid_argument("bus \"" + text +
                                "\" does not end in a number that can increase from bus to bus; "
                                "give one specification per bus, separated by spaces");
  const auto before = text.find_last_not_of("0123456789");
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return text.substr(0, begin) + std::to_string(std::stoull(text.substr(begin)) + add);
}

/// If the bit rate is known it must equal the planned one; nodes at different rates cannot
/// communicate.
void check_rate(const BusPlan& plan, const std::string& where) {
  if (!where.starts_with(kernel_bus)) return;
  const std::string interface = where.substr(kernel_bus.size());
  const auto rate = can::bitrate_per_s(interface);
  if (rate && std::abs(*rate - plan.bitrate_per_s) > rate_tolerance * plan.bitrate_per_s)
    throw std::invalid_argument(
        "interface \"" + interface + "\" runs at " + xml::write_number(*rate) +
        " bit/s, robot.xml plans " + xml::write_number(plan.bitrate_per_s) + " for bus \"" +
        plan.name + "\"; `ip link set " + interface + " down`, then up type can bitrate " +
        xml::write_number(plan.bitrate_per_s));
}

}  // namespace

// ---- routes ----

BusRoutes::BusRoutes(const Robot& robot) {
  for (const BusPlan& plan : robot.buses()) {
    for (const int ecu : plan.ecus) bus_of_[static_cast<std::size_t>(ecu)] = names_.size();
    names_.push_back(plan.name);
    ecus_.push_back(plan.ecus);
  }
  sorted_.resize(names_.size());
  for (auto& frames : sorted_) frames.reserve(gain_set_frames);  // no allocation later
}

void BusRoutes::sort(std::span<const CanFrame> frames) {
  for (auto& bus_frames : sorted_) bus_frames.clear();
  for (const CanFrame& frame : frames) {
    const std::uint8_t ecu = frame_ecu_of(&frame);
    if (ecu != FRAME_EVERYONE) sorted_[bus_of_[ecu]].push_back(frame);
    else
      for (auto& bus_frames : sorted_) bus_frames.push_back(frame);
  }
}

// ---- opening ----

std::vector<std::string> bus_specifications(const std::string& where, std::size_t buses) {
  const auto parts = xml::split(where);
  std::vector<std::string> words(parts.begin(), parts.end());
  if (words.size() == buses) return words;
  if (words.size() != 1)
    throw std::invalid_argument(
        "robot.xml plans " + std::to_string(buses) + " buses, \"" + where + "\" names " +
        std::to_string(words.size()) +
        "; give one per bus, or one whose last number increases from bus to bus");
  if (words[0].starts_with(trace)) return words;
  for (std::size_t k = 1; k < buses; ++k) words.push_back(with_increased_number(words[0], k));
  return words;
}

std::vector<std::unique_ptr<CanBus>> open_buses(const Robot& robot, const std::string& where,
                                                std::size_t window) {
  const auto plans = robot.buses();
  const auto words = bus_specifications(where, plans.size());
  std::vector<std::unique_ptr<CanBus>> buses;
  for (std::size_t k = 0; k < words.size(); ++k) {
    BusOptions options;
    options.fd = plans[k].data_bitrate_per_s.has_value();
    options.window = window * plans[k].ecus.size();
    buses.push_back(open_bus(words[k], options));
    check_rate(plans[k], words[k]);
  }
  return buses;
}

}  // namespace erp
