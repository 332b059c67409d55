#pragma once
#include <vector>

#include "sim/control/loop_shaping/joint_loops.hpp"

namespace sim::loop_shaping {

/// Largest and smallest singular value.
struct Spread {
  double largest, smallest;
};

/// A point of a singular value plot, the multivariable Bode plot.
struct LoopPoint {
  double Hz;
  Spread desired;   ///< of G W₁
  Spread achieved;  ///< of G K
  double s, t;      ///< largest singular value of (1 + G K)⁻¹ and of (1 + G K)⁻¹ G K
};
std::vector<LoopPoint> loop_curves(const JointLoops& loops, double low_Hz, double high_Hz,
                                   int count);

}  // namespace sim::loop_shaping
