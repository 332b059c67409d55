#pragma once
#include <string>

#include "sim/diagnosis/diagnose.hpp"

/// What the terminal and the report say in the same words.
namespace launch::gap {

/// "98.2 % closed", 100 at most: beyond is noise. Of what was no gap, or has grown, that.
std::string closed_words(const sim::diagnosis::Closed& closed);

/// " (98.1 … 98.4 %)", its interval; empty where closed_words says no share.
std::string closed_interval(const sim::diagnosis::Closed& closed);

/// "held-out recordings", where there were any; else the part of one that was.
std::string judged_on(const sim::diagnosis::Diagnosis& diagnosis);

/// "61 %" of a share that is not none.
std::string share_words(double share);

/// What else would look like a tendon that is so much longer or shorter that a shaft's zero would be
/// off by more than its effect may be. Empty: nothing.
std::string zero_doubt(const std::vector<sim::diagnosis::Named>& answer, const erp::Robot& robot);

/// Why effects that explain the residuals may still not be the cause: let run freely with them, the
/// simulator stays about as far from what was recorded. Empty if it comes nearer.
std::string free_run_doubt(const sim::diagnosis::Closed& free_run);

}  // namespace launch::gap
