#pragma once
#include "sim/gap/residuals/episode.hpp"

/// Recordings are held against each other stage by stage, so that all must tell the same.
namespace sim::residuals {

/// Leaves out of every recording what some recording lacks or has no sample of; of a robot's
/// commands, which make no stage, nothing. What is left out is told in `remarks`.
void keep_common(std::vector<Episode>& episodes, const erp::Robot& robot,
                 std::vector<std::string>& remarks);

}  // namespace sim::residuals
