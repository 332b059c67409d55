#pragma once
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/gap/diagnosis/diagnose.hpp"
#include "sim/gap/closed_loop/free_run.hpp"

/// What `erp gap diagnose` leaves in its folder.
namespace launch::gap {

/// diagnosis.json; its names are in sim/gap/diagnosis/README.md.
std::string diagnosis_json(const sim::diagnosis::Diagnosis& diagnosis,
                           const sim::closed_loop::FreeRun& free_run, const erp::Robot& robot);
/// report.html, self-contained.
std::string diagnosis_report(const sim::diagnosis::Diagnosis& diagnosis,
                             const sim::closed_loop::FreeRun& free_run, const erp::Robot& robot);
/// robot.xml: the text of the file `model`, comments and all, with the effects that were `added` before
/// its end; written anew as one file where the model is put together from several.
void write_mended(const std::string& file, const std::string& model, const erp::Robot& mended,
                  std::vector<erp::Effect> added);

}  // namespace launch::gap
