#pragma once
#include <netinet/in.h>

#include <string>

#include "firmware/board/board.h"
#include "hal/can/bus.hpp"

/// The firmware's main loop as a process of this machine: a real bus, and converters at the other end
/// of a datagram (firmware/board/wire.h). Their readings, each 2 ms of the simulated robot's time,
/// are its clock.
namespace board {

struct Place {
  std::string bus;  ///< as erp::open_bus
  erp::BusOptions bus_options;
  sockaddr_in converters{};  ///< where the simulated robot listens
};

/// Waits for the robot, runs, and returns when the robot is gone: no reading for 100 ms. Each
/// period it writes a byte to `kick`: who reads it is the watchdog. Throws std::runtime_error
/// without a bus.
void run(const board_fitted& fitted, const Place& place, frame_reset_cause cause, int kick);

}  // namespace board
