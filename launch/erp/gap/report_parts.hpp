#pragma once
#include <string>

#include "sim/gap/closed_loop/free_run.hpp"
#include "sim/gap/diagnosis/diagnose.hpp"

/// The parts of report.html, each a piece of the page; empty when there is nothing to say.
namespace launch::gap::page {

std::string name_of(const sim::diagnosis::IdentifiedEffect& named);  ///< "coulomb on m.gear"

// where
std::string chains(const sim::diagnosis::Diagnosis& diagnosis);
std::string moments(const sim::diagnosis::Diagnosis& diagnosis);  ///< the worst
// which
std::string ranking(const sim::diagnosis::Diagnosis& diagnosis);
std::string constants(const sim::diagnosis::Diagnosis& diagnosis);
std::string unexplained(const sim::diagnosis::Diagnosis& diagnosis);
// how far
std::string stages(const sim::diagnosis::Diagnosis& diagnosis);
std::string free_running(const sim::diagnosis::Diagnosis& diagnosis,
                         const sim::closed_loop::FreeRun& run);

}  // namespace launch::gap::page
