#pragma once
#include <functional>
#include <vector>

#include "launch/erp/gap/gap.hpp"
#include "sim/gap/closed_loop/free_run.hpp"
#include "sim/gap/diagnosis/diagnose.hpp"

/// Validates a diagnosis by free-run simulation.
namespace launch::gap {

/// Simulates the robot with the identified effects on the references of the held-out recordings.
/// Without a gap, simulates the unchanged model. If the answer is one supported effect and its
/// error exceeds the noise, also simulates at most four of its alternatives; one that at least
/// halves the smallest error so far replaces the answer, with a warning. Returns an empty result
/// without the option free_run, for robots with drives, which the simulator does not support, and
/// if there is a gap but no identified effect.
sim::closed_loop::FreeRun free_run_of(sim::diagnosis::Diagnosis& diagnosis,
                                      const std::vector<sim::residuals::Episode>& episodes,
                                      const erp::Robot& robot, const DiagnoseOptions& options,
                                      const std::function<void(double)>& progress);

}  // namespace launch::gap
