#pragma once
#include <string>
#include <vector>

#include "sim/gap/residuals/episode.hpp"

/// Limits of robot.xml. At a limit the recorded command differs from the value that acted.
///
///   |V| > supply             the supply voltage acts
///   |i| ≥ 0.97 i_max and     the driver limits i; V and i between rows are unknown
///   |V − K_E N ω|/R > 1.1 i_max
///   converter at its limit   the reading is a bound, not a value
///
/// A voltage above the supply is replaced by the supply. The other samples become NaN; only stages
/// that need them are not judged there.
namespace sim::estimation {

/// Applies the limits to all episodes. Adds a line to `remarks` for each limit that a recording
/// reaches.
void apply_limits(const erp::Robot& robot, std::vector<residuals::Episode>& episodes,
                  std::vector<std::string>& remarks);

}  // namespace sim::estimation
