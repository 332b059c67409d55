#pragma once
#include <string>
#include <vector>

#include "sim/gap/diagnosis/diagnose.hpp"

/// Phrases that the terminal output and the report share, and warnings about a diagnosis.
namespace launch::gap {

/// Gap closure as text: "98.2 % closed", at most 100 % because the excess is noise; "within the
/// noise" if there was no gap; "2.0 times as large" if the error increased.
std::string closure_text(const sim::diagnosis::ClosedGap& closed);

/// Interval of the gap closure: " (98.1 … 98.4 %)"; empty if closure_text gives no percentage.
std::string closure_interval(const sim::diagnosis::ClosedGap& closed);

/// Name of the validation data: "held-out recordings", "the rest of the recording", or "the
/// training data".
std::string validation_data(const sim::diagnosis::Diagnosis& diagnosis);

/// Parameters of an effect that are not fitted: "; distance_m = 0.25, not fitted". Empty if all are
/// fitted.
std::string fixed_parameters(const sim::diagnosis::IdentifiedEffect& effect);

/// Whether the recordings determine the constant and it deviates from its nominal value: the
/// interval excludes the nominal value, and the deviation exceeds half a tolerance.
bool deviates(const sim::diagnosis::ConstantEstimate& constant);

/// A share of the gap above 0 as a percentage: "61 %", "under 1 %".
std::string share_text(double share);

/// Warning about a tendon length offset that a wrong zero of the shaft encoder would also explain,
/// if that zero error exceeds the bounds of the effect sensor_shaft_offset. Otherwise empty.
std::string zero_offset_warning(const std::vector<sim::diagnosis::IdentifiedEffect>& answer,
                                const erp::Robot& robot);

/// Warning if the free-run error remains large: the identified effects may not be the cause, or a
/// model without a gap may still differ from the robot. Empty if the error is small.
std::string free_run_warning(const sim::diagnosis::Diagnosis& diagnosis,
                             const sim::diagnosis::ClosedGap& free_run);

/// All warnings about an answer: its free run, a residual that it raises above the noise floor, a
/// wrong encoder zero, and a scaled time column or a delayed column that would cause the same
/// residuals.
std::vector<std::string> answer_warnings(const sim::diagnosis::Diagnosis& diagnosis,
                                         const sim::diagnosis::ClosedGap& free_run,
                                         const erp::Robot& robot);

}  // namespace launch::gap
