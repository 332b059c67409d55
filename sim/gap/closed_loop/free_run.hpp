#pragma once
#include <functional>

#include "sim/gap/closed_loop/predicted_run.hpp"
#include "sim/gap/diagnosis/gap_closure.hpp"
#include "sim/gap/residuals/episode.hpp"

/// The gap as the simulator sees it: robot.xml is let run freely, in closed loop with the firmware,
/// on what a recording was asked, and compared with what was recorded. A loop hides gaps in what it
/// controls, so effort is compared as well: voltages, currents and tensions.
///
///   error = rms(simulated − recorded)        floor: of two rehearsals that differ in their noise
///   all   = sqrt(mean (error/floor)²) over channels
namespace sim::closed_loop {

struct FreeRun {
  std::vector<diagnosis::Closed> channels;  ///< "flexor.tension_N" …
  diagnosis::Closed all;                    ///< unit "noise"
  std::vector<std::string> remarks;         ///< recordings that were left out, and why
};

struct FreeRunOptions {
  int threads = 2;
  std::uint64_t seed = 1;
  std::function<void(double)> progress = {};  ///< 0 … 1
};

/// Of a robot as given and with what was found, over some recordings; intervals by blocks of them,
/// a second each. Recordings in which a hinge does not start where the model starts, that lack
/// modes or references, or in which a rehearsal fails, are left out with a remark. Where a
/// spherical joint starts is not checked.
FreeRun free_run(const erp::Robot& nominal, const erp::Robot& found,
                 std::span<const residuals::Episode> recordings,
                 const FreeRunOptions& options = {});

}  // namespace sim::closed_loop
