#pragma once
#include <vector>

#include "sim/control/loop_shaping/joint_loops.hpp"

namespace sim::loop_shaping {

/// Singular values over frequency, largest and smallest.
struct Spread {
  double largest, smallest;
};

/// What a Bode plot is of many loops.
struct LoopPoint {
  double Hz;
  Spread wanted;  ///< of G W₁
  Spread got;     ///< of G K
  double s, t;    ///< largest of (1 + G K)⁻¹ and of (1 + G K)⁻¹ G K
};
std::vector<LoopPoint> loop_curves(const JointLoops& loops, double low_Hz, double high_Hz,
                                   int count);

}  // namespace sim::loop_shaping
