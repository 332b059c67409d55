#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Commands are lost, each with the same probability; the previous command stays in effect.
///
/// Ignores bursts. Source: Gilbert 1960.
struct FrameLoss {
  static constexpr About about{"bus_frame_loss", Stage::bus, Seat::robot,
                               "fast changes of the references"};

  double probability = 0;

  void visit(auto& v) { v("probability", probability, Bounds{0, 0.9}); }
  bool loses_command(double uniform) const { return uniform < probability; }
};

}  // namespace sim::effects
