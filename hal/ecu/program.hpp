#pragma once
#include <netinet/in.h>

#include <string>

#include "firmware/board/board.h"
#include "hal/can/bus.hpp"

/// The firmware's main loop as a process of this machine: a real bus, and converters of a simulated
/// robot, reached by datagrams (firmware/board/wire.h). Their readings arrive every 2 ms of
/// simulated time and are its clock.
namespace board {

struct Place {
  std::string bus;  ///< as erp::open_bus
  erp::BusOptions bus_options;
  sockaddr_in converters{};  ///< address of the simulated robot's converters
};

/// Waits for the robot, runs, and returns when no reading has arrived for 100 ms. Writes a byte to
/// `kick` every period, for the watchdog. Throws std::runtime_error if the bus cannot be opened.
void run(const board_fitted& fitted, const Place& place, frame_reset_cause cause, int kick);

}  // namespace board
