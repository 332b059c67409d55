#pragma once
#include <sys/types.h>

#include <cstdint>
#include <vector>

#include "hal/ecu/program.hpp"

/// What surrounds the microcontrollers: supply, reset circuit, watchdog and PWM stage of each.
///
///   ended by SIGKILL, SIGTERM   its supply broke down: PWM off, restarted after 20 ms, says so
///   the robot is gone           the same
///   ended otherwise, or it worked 10 ms without a kick   its watchdog: PWM off, restarted, says so
///   ended by an error it told   stays off
namespace board {

struct Rack {
  struct Slot {
    board_fitted fitted;
    Place place;
  };
  std::vector<Slot> slots;
};

/// Powers all ECUs until SIGINT or SIGTERM. Returns 0, or 1 when none could run.
int run_rack(const Rack& rack);

}  // namespace board
