#pragma once
#include "sim/model/effects/effect.hpp"

namespace sim::effects {

/// Commands get lost, each with the same probability; the one before holds on.
///
/// Source: Gilbert 1960, without bursts.
struct FrameLoss {
  static constexpr About about{"bus_frame_loss", Stage::bus, Seat::robot,
                               "references that change fast"};

  double probability = 0;

  void visit(auto& v) { v("probability", probability, Bounds{0, 0.9}); }
  bool loses_command(double uniform) const { return uniform < probability; }
};

}  // namespace sim::effects
