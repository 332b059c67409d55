#pragma once
#include "sim/gap/residuals/episode.hpp"

/// Recordings are compared stage by stage, so all must have the same signals.
namespace sim::residuals {

/// Removes from every recording the measured signals that another one lacks or has no sample of. Commands stay, for no
/// stage depends on them. Adds a line to `remarks` for each removed signal.
void keep_common(std::vector<Episode>& episodes, const erp::Robot& robot,
                 std::vector<std::string>& remarks);

}  // namespace sim::residuals
