#pragma once
#include <functional>

#include "sim/gap/closed_loop/predicted_run.hpp"
#include "sim/gap/diagnosis/gap_closure.hpp"
#include "sim/gap/residuals/episode.hpp"

/// The gap in closed loop: a free run of the simulator with the firmware and the set-points of a
/// recording is compared with the recording. A control loop hides errors in the quantity that it
/// controls. Therefore voltages, currents and tensions are compared too.
///
///   error = rms(simulated − recorded)        floor: rms difference of two runs with different noise
///   all   = sqrt(mean (error/floor)²) over channels
namespace sim::closed_loop {

struct FreeRun {
  std::vector<diagnosis::ClosedGap> channels;  ///< "flexor.tension_N" …
  diagnosis::ClosedGap all;                    ///< unit "noise"
  std::vector<std::string> remarks;            ///< omitted recordings, with the reason
};

struct FreeRunOptions {
  int threads = 2;
  std::uint64_t seed = 1;
  std::function<void(double)> progress = {};  ///< 0 … 1
};

/// Compares the nominal robot (before) and the robot `found` (after) with the recordings. Intervals
/// are computed by a bootstrap over seconds. These recordings are omitted with a remark: a hinge
/// does not start in the model's initial pose; modes or references are missing; the simulation
/// fails. The start of spherical joints is not checked.
FreeRun free_run(const erp::Robot& nominal, const erp::Robot& found,
                 std::span<const residuals::Episode> recordings,
                 const FreeRunOptions& options = {});

}  // namespace sim::closed_loop
