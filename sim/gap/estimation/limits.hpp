#pragma once
#include <string>
#include <vector>

#include "sim/gap/residuals/episode.hpp"

/// Limits that robot.xml states are laws too: at one of them the recorded command is not what acted.
///
///   |V| > supply            the supply acts
///   |i| ≥ 0.97 i_max        and the command would drive more: the driver holds i, neither V nor
///                         the current between rows is known
///   a converter at its end  the reading is a bound, not a value
///
/// Such samples become NaN: stages that need them are not judged there, others still are.
namespace sim::estimation {

/// Adds a line to `remarks` for each limit that a recording meets.
void apply_limits(const erp::Robot& robot, std::vector<residuals::Episode>& episodes,
                  std::vector<std::string>& remarks);

}  // namespace sim::estimation
