#pragma once
#include "interfaces/recording/table.hpp"
#include "sim/learning/muscle_networks/learned_lengths.hpp"

namespace sim::muscle_networks {

struct SampleOptions {
  double taut_N = 2;       ///< rows with a smaller tension are skipped; chosen
  std::size_t every = 10;  ///< rows per sample: 20 ms; chosen
};

/// Rows of a recording as samples. The path length follows from the measured shaft angle and
/// tension, by the line wound on robot.xml's spindle and the stretch of its spring,
///
///   l = Δx(F) − r θ + constant
///
/// Rows that lack a joint position or shaft angle, or have a slack tendon, are skipped. Throws
/// std::invalid_argument if the table lacks the columns of a joint or actuator.
LengthSamples samples_of(const erp::Robot& robot, const recording::Table& table,
                         const SampleOptions& options = {});

}  // namespace sim::muscle_networks
