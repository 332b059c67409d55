#pragma once
#include <cstdint>

#include "interfaces/recording/table.hpp"
#include "interfaces/robot/robot.hpp"

namespace sim::muscle_networks {

struct BabbleOptions {
  double duration_s = 300;
  double every_s = 0.7;  ///< from one draw to the next; chosen: limbs get somewhere meanwhile
  double least_N = 4;    ///< no tendon goes slack
  double mean_N = 15;    ///< above the least: most pull little, few at a time much
  double share = 0.5;    ///< of what each may pull at most
  std::uint64_t seed = 1;
};

/// Motor babbling: a trajectory of tendon forces for `target`, drawn anew and anew,
///
///   F = F_least + x,  x exponential of mean x̄,  straight from one draw to the next
///
/// It begins at the pretensions of robot.xml.
recording::Table babble(const erp::Robot& robot, const BabbleOptions& options = {});

}  // namespace sim::muscle_networks
