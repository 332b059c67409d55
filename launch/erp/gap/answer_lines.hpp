#pragma once
#include <iosfwd>

#include "launch/erp/gap/gap.hpp"
#include "sim/gap/closed_loop/free_run.hpp"
#include "sim/gap/diagnosis/diagnose.hpp"

/// A diagnosis as terminal output.
namespace launch::gap {

/// Prints location, cause, constants, gap closure, free run, warnings, faults of the recordings,
/// and the verdict.
void print_answer(const sim::diagnosis::Diagnosis& diagnosis,
                  const sim::closed_loop::FreeRun& free_run, std::ostream& out);

/// Prints the `erp gap plan` command if the gap is not explained or equivalent effects remain.
/// Prints nothing if the recordings have faults, which must be fixed first.
void print_next(const sim::diagnosis::Diagnosis& diagnosis, const erp::Robot& robot,
                const DiagnoseOptions& options, std::ostream& out);

}  // namespace launch::gap
