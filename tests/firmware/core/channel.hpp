#pragma once
#include <array>
#include <cstdint>

#include "firmware/core/ecu.h"

/// A channel with the rig's numbers, ticked by the test.
namespace firmware {

using Gains = std::array<float, ECU_PARAMETER_COUNT>;

inline constexpr float pi = 3.14159265f;

/// The published motor on the rig's sensors: 2048 counts per motor turn, gear 128, 12 bits.
inline Gains rig_gains() {
  Gains g{};
  g[ECU_PARAMETER_SUPPLY] = 12;
  g[ECU_PARAMETER_SHAFT_SCALE] = 2 * pi / (2048 * 128);
  g[ECU_PARAMETER_CURRENT_SCALE] = 8.0f / 2048;
  g[ECU_PARAMETER_CURRENT_COUNTS_MAX] = 2047;
  g[ECU_PARAMETER_TENSION_SCALE] = 200.0f / 4095;
  g[ECU_PARAMETER_TENSION_COUNTS_MAX] = 4095;
  g[ECU_PARAMETER_RESISTANCE] = 0.516f;
  g[ECU_PARAMETER_BACK_EMF] = 11.5e-3f * 128;
  g[ECU_PARAMETER_CURRENT_LIMIT] = 4;
  g[ECU_PARAMETER_CURRENT_TRIP] = 6;
  g[ECU_PARAMETER_TENSION_LIMIT] = 150;
  g[ECU_PARAMETER_TENSION_TRIP] = 180;
  g[ECU_PARAMETER_SHAFT_MIN] = -20;
  g[ECU_PARAMETER_SHAFT_MAX] = 20;
  g[ECU_PARAMETER_LENGTH_KP] = 40;
  g[ECU_PARAMETER_CURRENT_KP] = 0.2f;
  g[ECU_PARAMETER_CURRENT_KI] = 100;
  g[ECU_PARAMETER_CURRENT_KD] = 0;
  g[ECU_PARAMETER_FORCE_K_CURRENT] = 0;
  g[ECU_PARAMETER_FORCE_K_SPEED] = 0;
  g[ECU_PARAMETER_FORCE_K_TENSION] = 0.2f;
  g[ECU_PARAMETER_FORCE_PREFILTER] = 0.2f;
  return g;
}

/// The same with all sensors that an ECU supports: a live zero of 10 %, a ten-turn potentiometer
/// of 12 bits, a winding temperature sensor of 0.1 degrees per count, a supply sensor.
inline Gains fitted_gains() {
  Gains g = rig_gains();
  g[ECU_PARAMETER_TENSION_ZERO] = 410;
  g[ECU_PARAMETER_CURRENT_STUCK_SPEED] = 0.5f;
  g[ECU_PARAMETER_TENSION_STUCK_SPEED] = 0.5f;
  g[ECU_PARAMETER_WIPER_SCALE] = 20 * pi / 4096;
  g[ECU_PARAMETER_WIPER_COUNTS_MAX] = 4095;
  g[ECU_PARAMETER_WIPER_TOLERANCE] = 0.1f;
  g[ECU_PARAMETER_CURRENT_CONTINUOUS] = 2;
  g[ECU_PARAMETER_OVERLOAD_LIMIT] = 24;
  g[ECU_PARAMETER_TEMPERATURE_SCALE] = 0.1f;
  g[ECU_PARAMETER_TEMPERATURE_ZERO] = -40;
  g[ECU_PARAMETER_TEMPERATURE_DERATE] = 80;
  g[ECU_PARAMETER_TEMPERATURE_TRIP] = 100;
  g[ECU_PARAMETER_SUPPLY_SCALE] = 0.005f;
  g[ECU_PARAMETER_SUPPLY_MIN] = 9;
  return g;
}

/// Writes a complete set; returns the result of the commit.
inline bool load(ecu_channel& channel, const Gains& gains) {
  bool accepted = false;
  for (std::uint8_t i = 0; i < ECU_PARAMETER_COUNT; ++i)
    accepted = ecu_parameter(&channel, i, gains[i], i + 1 == ECU_PARAMETER_COUNT);
  return accepted;
}

inline ecu_channel in_state(ecu_state state, const Gains& gains = rig_gains()) {
  ecu_channel channel;
  ecu_init(&channel);
  if (state == ECU_STATE_BOOT) return channel;
  load(channel, gains);
  if (state == ECU_STATE_FAULT) ecu_trip(&channel, ECU_FAULT_OVER_CURRENT);
  if (state == ECU_STATE_ARMED || state == ECU_STATE_RUNNING)
    ecu_command(&channel, ECU_REQUEST_ARM, 0);
  if (state == ECU_STATE_RUNNING) ecu_command(&channel, ECU_REQUEST_VOLTAGE, 1000);
  return channel;
}

inline std::int16_t tick(ecu_channel& channel, ecu_inputs inputs = {}) {
  return ecu_tick(&channel, &inputs);
}

}  // namespace firmware
