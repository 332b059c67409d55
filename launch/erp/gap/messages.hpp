#pragma once
#include <string>
#include <vector>

#include "sim/gap/diagnosis/diagnose.hpp"

/// What the terminal and the report say in the same words.
namespace launch::gap {

/// "98.2 % closed", 100 at most: beyond is noise. Of what was no gap, or has grown, that.
std::string closed_words(const sim::diagnosis::Closed& closed);

/// " (98.1 … 98.4 %)", its interval; empty where closed_words says no share.
std::string closed_interval(const sim::diagnosis::Closed& closed);

/// "held-out recordings", where there were any; else the part of one that was.
std::string judged_on(const sim::diagnosis::Diagnosis& diagnosis);

/// "; distance_m = 0.25, not fitted": what of an effect was taken as it is. Empty: nothing.
std::string taken_as_it_is(const sim::diagnosis::IdentifiedEffect& effect);

/// Whether the recordings determine a constant, and show that it is not as described: its interval excludes the
/// nominal value, which is more than half a tolerance away.
bool is_off(const sim::diagnosis::ConstantEstimate& constant);

/// "61 %" of a share that is not none.
std::string share_words(double share);

/// What else would look like a tendon that is so much longer or shorter that a shaft's zero would be
/// off by more than its effect may be. Empty: nothing.
std::string zero_doubt(const std::vector<sim::diagnosis::IdentifiedEffect>& answer,
                       const erp::Robot& robot);

/// Why effects that explain the residuals may still not be the cause, or a model without a gap not be
/// the robot: let run freely, the simulator stays far from what was recorded. Empty if it does not.
std::string free_run_doubt(const sim::diagnosis::Diagnosis& diagnosis,
                           const sim::diagnosis::Closed& free_run);

/// Those, and what else speaks against an answer that the recordings support: a stage that it takes
/// from its floor, a time column or one that is late that would look alike.
std::vector<std::string> doubts(const sim::diagnosis::Diagnosis& diagnosis,
                                const sim::diagnosis::Closed& free_run, const erp::Robot& robot);

}  // namespace launch::gap
