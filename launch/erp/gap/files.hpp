#pragma once
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/gap/closed_loop/free_run.hpp"
#include "sim/gap/diagnosis/diagnose.hpp"

/// Files that `erp gap diagnose` writes to its output folder.
namespace launch::gap {

/// Text of diagnosis.json; sim/gap/diagnosis/README.md defines its fields.
std::string diagnosis_json(const sim::diagnosis::Diagnosis& diagnosis,
                           const sim::closed_loop::FreeRun& free_run, const erp::Robot& robot);
/// Text of report.html, which needs no other file.
std::string diagnosis_report(const sim::diagnosis::Diagnosis& diagnosis,
                             const sim::closed_loop::FreeRun& free_run, const erp::Robot& robot);
/// Writes robot.xml: the text of the file `model` with its comments, and the effects `added` at its
/// end. If the model includes other files, writes `corrected` as one file without comments.
void write_corrected(const std::string& file, const std::string& model, const erp::Robot& corrected,
                     std::vector<erp::Effect> added);

}  // namespace launch::gap
