#pragma once
#include <string>

#include "sim/gap/closed_loop/free_run.hpp"
#include "sim/gap/diagnosis/diagnose.hpp"

/// The sections of report.html, each as HTML. A section is empty if there is nothing to report.
namespace launch::gap::page {

std::string name_of(const sim::diagnosis::IdentifiedEffect& effect);  ///< "coulomb on m.gear"

// localization
std::string chains(const sim::diagnosis::Diagnosis& diagnosis);
std::string worst_windows(const sim::diagnosis::Diagnosis& diagnosis);
// identification
std::string ranking(const sim::diagnosis::Diagnosis& diagnosis);
std::string constants(const sim::diagnosis::Diagnosis& diagnosis);
std::string unexplained(const sim::diagnosis::Diagnosis& diagnosis);
// gap closure
std::string stages(const sim::diagnosis::Diagnosis& diagnosis);
std::string free_run(const sim::diagnosis::Diagnosis& diagnosis,
                     const sim::closed_loop::FreeRun& run);

}  // namespace launch::gap::page
