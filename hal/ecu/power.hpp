#pragma once
#include <sys/types.h>

#include <cstdint>
#include <vector>

#include "hal/ecu/program.hpp"

/// The hardware around the microcontrollers: supply, reset circuit, watchdog and PWM stage of each.
///
///   ended by SIGKILL, SIGTERM      loss of supply: PWM off, restart after 20 ms, cause reported
///   the robot no longer answers    as for SIGKILL
///   ended otherwise, or 10 ms of computing without a kick
///                                  watchdog: PWM off, restart, cause reported
///   ended with an error message    stays off
namespace board {

struct Rack {
  struct Slot {
    board_fitted fitted;
    Place place;
  };
  std::vector<Slot> slots;
};

/// Runs all ECUs until SIGINT or SIGTERM. Returns 0, or 1 when none could run.
int run_rack(const Rack& rack);

}  // namespace board
