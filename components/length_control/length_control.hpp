#pragma once
#include "components/follow/follow.hpp"
#include "firmware/core/laws.h"

/// Line length control, paper 5.1 (ii):  V = k_P (shaft_ref − shaft),  shaft_ref = −l_ref / r.
struct LengthLaw {
  static constexpr erp::Mode mode = erp::Mode::length;
  static constexpr std::uint8_t needed = erp::valid::shaft;
  static float voltage_V(const follow::Channel& channel, float line_ref_m,
                         const erp::ActuatorSample& sample, float /*speed_rad_per_s*/) {
    const float shaft_ref_rad = -line_ref_m / static_cast<float>(channel.radius_m);
    return law_length_V(channel.gain(ECU_PARAMETER_LENGTH_KP), shaft_ref_rad,
                        static_cast<float>(sample.shaft_rad));
  }
};

using LengthControl = follow::Follow<LengthLaw>;
