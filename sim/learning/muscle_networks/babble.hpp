#pragma once
#include <cstdint>

#include "interfaces/recording/table.hpp"
#include "interfaces/robot/robot.hpp"

namespace sim::muscle_networks {

struct BabbleOptions {
  double duration_s = 300;
  double every_s = 0.7;  ///< interval between draws; chosen: limbs move noticeably
  double least_N = 4;    ///< smallest force, which keeps the tendons taut
  double mean_N = 15;    ///< above `least_N`; most muscles pull weakly, few strongly
  double share = 0.5;    ///< upper limit, relative to the muscle's maximum tension
  std::uint64_t seed = 1;
};

/// Motor babbling: a trajectory of random tendon forces for `target`,
///
///   F = F_least + x,  x exponential with mean x̄,  linear from one draw to the next
///
/// It begins at the pretensions of robot.xml.
recording::Table babble(const erp::Robot& robot, const BabbleOptions& options = {});

}  // namespace sim::muscle_networks
