#pragma once
#include "sim/gap/residuals/episode.hpp"

/// The signals that all recordings have. Recordings are evaluated jointly, stage by stage, and need
/// the same signals.
namespace sim::residuals {

/// Removes from every recording the measured signals for which another recording has no column or
/// no sample. Commands are not removed because no stage depends on them. Adds a line to `remarks`
/// for each removed signal.
void keep_common(std::vector<Episode>& episodes, const erp::Robot& robot,
                 std::vector<std::string>& remarks);

}  // namespace sim::residuals
