#pragma once
#include <iosfwd>

#include "launch/erp/gap/gap.hpp"
#include "sim/gap/diagnosis/diagnose.hpp"
#include "sim/gap/closed_loop/free_run.hpp"

/// A diagnosis as lines on a terminal.
namespace launch::gap {

/// Where, which, how far, the constants, warnings, what is to be mended first, and last the verdict.
void print_answer(const sim::diagnosis::Diagnosis& diagnosis,
                  const sim::closed_loop::FreeRun& free_run, std::ostream& out);

/// What to do next where several answers are left or none is enough; nothing while recordings are to be mended first.
void print_next(const sim::diagnosis::Diagnosis& diagnosis, const erp::Robot& robot,
                const DiagnoseOptions& options, std::ostream& out);

}  // namespace launch::gap
