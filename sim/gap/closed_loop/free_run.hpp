#pragma once
#include <functional>

#include "sim/gap/closed_loop/predicted_run.hpp"
#include "sim/gap/diagnosis/gap_closure.hpp"
#include "sim/gap/residuals/episode.hpp"

/// The gap in closed loop: a free run of the simulator with the firmware and the set-points of a recording is
/// compared with the recording. A loop hides errors in the quantity that it controls, so voltages, currents and
/// tensions are compared as well.
///
///   error = rms(simulated − recorded)        floor: rms difference of two runs with different noise
///   all   = sqrt(mean (error/floor)²) over channels
namespace sim::closed_loop {

struct FreeRun {
  std::vector<diagnosis::Closed> channels;  ///< "flexor.tension_N" …
  diagnosis::Closed all;                    ///< unit "noise"
  std::vector<std::string> remarks;         ///< recordings that were left out, with the reason
};

struct FreeRunOptions {
  int threads = 2;
  std::uint64_t seed = 1;
  std::function<void(double)> progress = {};  ///< 0 … 1
};

/// Compares the nominal robot (before) and `found` (after) with the recordings. Intervals by a bootstrap over
/// seconds. Left out with a remark: recordings in which a hinge does not start in the model's initial pose, that
/// lack modes or references, or whose simulation fails. The start of spherical joints is not checked.
FreeRun free_run(const erp::Robot& nominal, const erp::Robot& found,
                 std::span<const residuals::Episode> recordings,
                 const FreeRunOptions& options = {});

}  // namespace sim::closed_loop
