#include "firmware/core/strain.h"

#include "firmware/core/checks.h"

/* A converter that is not fitted has scale 0. */
static float temperature_C(const float* gains, const ecu_inputs* inputs) {
  return GAIN(TEMPERATURE_ZERO) + (float)inputs->temperature_counts * GAIN(TEMPERATURE_SCALE);
}

static bool is_over_current(const float* gains, const ecu_inputs* inputs) {
  const float current_A = (float)inputs->current_counts * GAIN(CURRENT_SCALE);
  return current_A > GAIN(CURRENT_TRIP) || current_A < -GAIN(CURRENT_TRIP);
}

static bool is_hot(const float* gains, const ecu_inputs* inputs) {
  const bool fitted = GAIN(TEMPERATURE_SCALE) != 0.0f;
  return fitted && temperature_C(gains, inputs) >= GAIN(TEMPERATURE_TRIP);
}

static bool is_supply_low(const float* gains, const ecu_inputs* inputs) {
  const bool fitted = GAIN(SUPPLY_SCALE) > 0.0f;
  return fitted && (float)inputs->supply_counts * GAIN(SUPPLY_SCALE) < GAIN(SUPPLY_MIN);
}

static float heat_after(float heat_A2_s, const float* gains, float current_A) {
  const float continuous_A = GAIN(CURRENT_CONTINUOUS);
  const float heat =
      heat_A2_s + (current_A * current_A - continuous_A * continuous_A) * ECU_PERIOD_S;
  return heat > 0.0f ? heat : 0.0f;
}

ecu_fault ecu_strain_tick(ecu_strain* s, const float* gains, const ecu_sensed* sensed,
                          const ecu_inputs* inputs) {
  s->over_current_ticks = count_consecutive(is_over_current(gains, inputs), s->over_current_ticks);
  s->hot_ticks = count_consecutive(is_hot(gains, inputs), s->hot_ticks);
  s->low_supply_ticks = count_consecutive(is_supply_low(gains, inputs), s->low_supply_ticks);
  s->heat_A2_s = heat_after(s->heat_A2_s, gains, sensed->current_A);
  if (s->over_current_ticks >= ECU_OVER_CURRENT_TICKS) return ECU_FAULT_OVER_CURRENT;
  if (sensed->tension_N > GAIN(TENSION_TRIP)) return ECU_FAULT_OVER_TENSION;
  if (GAIN(OVERLOAD_LIMIT) > 0.0f && s->heat_A2_s > GAIN(OVERLOAD_LIMIT)) return ECU_FAULT_OVERLOAD;
  if (s->hot_ticks >= ECU_HOT_TICKS) return ECU_FAULT_OVER_TEMPERATURE;
  if (s->low_supply_ticks >= ECU_LOW_SUPPLY_TICKS) return ECU_FAULT_SUPPLY;
  return ECU_FAULT_NONE;
}

float ecu_current_limit_A(const float* gains, const ecu_inputs* inputs) {
  const float limit_A = GAIN(CURRENT_LIMIT);
  if (GAIN(TEMPERATURE_SCALE) == 0.0f) return limit_A;
  const float fraction = (GAIN(TEMPERATURE_TRIP) - temperature_C(gains, inputs)) /
                         (GAIN(TEMPERATURE_TRIP) - GAIN(TEMPERATURE_DERATE));
  if (!(fraction > 0.0f)) return 0.0f;
  return fraction < 1.0f ? fraction * limit_A : limit_A;
}

void ecu_strain_clear(ecu_strain* strain) {
  strain->over_current_ticks = strain->hot_ticks = strain->low_supply_ticks = 0u;
}
