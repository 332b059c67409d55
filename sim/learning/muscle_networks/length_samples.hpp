#pragma once
#include "interfaces/recording/table.hpp"
#include "sim/learning/muscle_networks/learnt_lengths.hpp"

namespace sim::muscle_networks {

struct SampleOptions {
  double taut_N = 2;       ///< with a tendon slacker than that a row tells nothing; chosen
  std::size_t every = 10;  ///< rows from one sample to the next: 20 ms; chosen
};

/// Rows of a recording as samples: path lengths follow from what actuators measure, by the line
/// that robot.xml's spindle has wound and the stretch of its spring under the tension,
///
///   l = Δx(F) − r θ + constant
///
/// Rows without a joint's position, a shaft's angle or a taut tendon are left out. Throws
/// std::invalid_argument naming a joint or actuator that the table has no columns of.
LengthSamples samples_of(const erp::Robot& robot, const recording::Table& table,
                         const SampleOptions& options = {});

}  // namespace sim::muscle_networks
