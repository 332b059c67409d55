#pragma once
#include <string>

#include "interfaces/robot/robot.hpp"
#include "sim/diagnosis/diagnose.hpp"
#include "sim/rehearsal/free_run.hpp"

/// What `erp gap diagnose` leaves in its folder.
namespace launch::gap {

/// diagnosis.json; its names are in sim/diagnosis/README.md.
std::string diagnosis_json(const sim::diagnosis::Diagnosis& diagnosis,
                           const sim::rehearsal::FreeRun& free_run, const erp::Robot& robot);
/// report.html, self-contained.
std::string diagnosis_report(const sim::diagnosis::Diagnosis& diagnosis,
                             const sim::rehearsal::FreeRun& free_run, const erp::Robot& robot);
}  // namespace launch::gap
