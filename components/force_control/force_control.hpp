#pragma once
#include "components/follow/follow.hpp"
#include "firmware/core/laws.h"

/// Tendon force control, paper 5.1 (iv):  V = P F_ref − k_i i − k_ω ω − k_F F.
struct ForceLaw {
  static constexpr erp::Mode mode = erp::Mode::force;
  static constexpr std::uint8_t needed = erp::valid::current | erp::valid::tension;
  static float voltage_V(const follow::Channel& channel, float force_ref_N,
                         const erp::ActuatorSample& sample, float speed_rad_per_s) {
    const law_force_gains gains{
        channel.gain(ECU_PARAMETER_FORCE_K_CURRENT), channel.gain(ECU_PARAMETER_FORCE_K_SPEED),
        channel.gain(ECU_PARAMETER_FORCE_K_TENSION), channel.gain(ECU_PARAMETER_FORCE_PREFILTER)};
    return law_force_V(&gains, force_ref_N, static_cast<float>(sample.current_A), speed_rad_per_s,
                       static_cast<float>(sample.tension_N));
  }
};

using ForceControl = follow::Follow<ForceLaw>;
