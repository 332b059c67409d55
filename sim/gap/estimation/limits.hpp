#pragma once
#include <string>
#include <vector>

#include "sim/gap/residuals/episode.hpp"

/// Limits of robot.xml: at a limit the recorded command is not what acted.
///
///   |V| > supply            the supply voltage acts
///   |i| ≥ 0.97 i_max        and the command would drive more: the driver limits i; neither V nor the current between
///                           rows is known
///   converter at its limit  the reading is a bound, not a value
///
/// A voltage above the supply is replaced by the supply. Other such samples become NaN: stages that need them are not
/// judged there, other stages are.
namespace sim::estimation {

/// Adds a line to `remarks` for each limit that a recording reaches.
void apply_limits(const erp::Robot& robot, std::vector<residuals::Episode>& episodes,
                  std::vector<std::string>& remarks);

}  // namespace sim::estimation
