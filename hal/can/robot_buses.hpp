#pragma once
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/can/bus.hpp"
#include "interfaces/robot/robot.hpp"

/// A robot's CAN buses: which ECU is on which bus, and where each bus is opened.
namespace erp {

/// Assigns frames to a robot's buses.
class BusRoutes {
 public:
  explicit BusRoutes(const Robot& robot);
  std::size_t count() const { return sorted_.size(); }
  const std::string& name(std::size_t bus) const { return names_[bus]; }
  std::span<const int> ecus(std::size_t bus) const { return ecus_[bus]; }
  std::size_t bus_of(int ecu) const { return bus_of_[static_cast<std::size_t>(ecu)]; }

  /// Sorts frames by their ECU's bus and keeps their order; a DISCOVER to all ECUs goes on each
  /// bus.
  void sort(std::span<const CanFrame> frames);
  /// The frames of the last `sort` for one bus.
  std::span<const CanFrame> on(std::size_t bus) const { return sorted_[bus]; }

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<int>> ecus_;
  std::array<std::size_t, FRAME_ECUS + 1> bus_of_{};
  std::vector<std::vector<CanFrame>> sorted_;
};

/// Opens the buses of `robot.buses()`, in order. `where` gives one specification of `open_bus` per
/// bus, separated by spaces, or one for all, whose last number increases from bus to bus:
/// socketcan:can0 is can0, can1 … ; udp:239.255.42.1:20000 is port 20000, 20001 … A `trace:` is
/// opened once, as the first bus, and contains the frames of all buses. `window` frames per ECU may
/// be in flight (0: no limit). Throws std::invalid_argument when the number of specifications is
/// wrong or a bus does not run at robot.xml's bit rate, and as open_bus does.
std::vector<std::unique_ptr<CanBus>> open_buses(const Robot& robot, const std::string& where,
                                                std::size_t window = 0);

/// One specification per bus, as above.
std::vector<std::string> bus_specifications(const std::string& where, std::size_t buses);

}  // namespace erp
