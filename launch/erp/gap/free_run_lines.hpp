#pragma once
#include <functional>
#include <vector>

#include "launch/erp/gap/gap.hpp"
#include "sim/gap/closed_loop/free_run.hpp"
#include "sim/gap/diagnosis/diagnose.hpp"

/// A diagnosis held against the simulator.
namespace launch::gap {

/// The answer in the simulator, on the recordings held out; without a gap the model as it is. Of
/// effects that the residuals cannot tell apart, the one with which the simulator stays nearest is
/// put first, if it halves what is left; `warnings` tells. Nothing of drives, which the simulator
/// does not run, nor where there is a gap and no answer.
sim::closed_loop::FreeRun run_freely(sim::diagnosis::Diagnosis& diagnosis,
                                     const std::vector<sim::residuals::Episode>& episodes,
                                     const erp::Robot& robot, const DiagnoseOptions& options,
                                     const std::function<void(double)>& progress);

}  // namespace launch::gap
