#include "firmware/core/sensing.h"

#include "firmware/core/checks.h"

/* Of sensing.h, check `encoder`: the motor turns above this fraction of R i_limit; the encoder must
 * show this fraction of the back-EMF. Chosen. */
#define TURNING_FRACTION 0.75f
#define ENCODER_FRACTION 0.125f

static float magnitude(float x) { return x < 0.0f ? -x : x; }

/* ---- counts to SI ---- */

static bool current_at_rail(const float* gains, const ecu_inputs* inputs) {
  return magnitude((float)inputs->current_counts) >= GAIN(CURRENT_COUNTS_MAX);
}

/* Without a live zero, tension 0 is a slack tendon and not a rail. */
static bool tension_at_rail(const float* gains, const ecu_inputs* inputs) {
  const float counts = (float)inputs->tension_counts, half_zero = 0.5f * GAIN(TENSION_ZERO);
  return counts >= GAIN(TENSION_COUNTS_MAX) || counts < half_zero;
}

/* With a slack tendon, noise may bring the reading slightly below the live zero; a tendon does not
 * push. */
static float tension_of(const float* gains, const ecu_inputs* inputs) {
  const float counts = (float)inputs->tension_counts - GAIN(TENSION_ZERO);
  return counts > 0.0f ? counts * GAIN(TENSION_SCALE) : 0.0f;
}

/* No motor turns at twice its no-load speed at this supply. */
static bool speed_at_rail(const float* gains, float speed_rad_per_s) {
  return GAIN(BACK_EMF) * magnitude(speed_rad_per_s) > 2.0f * GAIN(SUPPLY);
}

static float speed_of(const ecu_sensed* s, const float* gains, const ecu_inputs* inputs) {
  const uint32_t now = (uint32_t)inputs->encoder_counts, last = (uint32_t)s->inputs.encoder_counts;
  return s->has_inputs ? (float)(int32_t)(now - last) * GAIN(SHAFT_SCALE) / ECU_PERIOD_S : 0.0f;
}

static void convert(ecu_sensed* s, const float* gains, const ecu_inputs* inputs) {
  const float speed_rad_per_s = speed_of(s, gains, inputs);
  const bool current_lost = current_at_rail(gains, inputs),
             tension_lost = tension_at_rail(gains, inputs),
             speed_lost = speed_at_rail(gains, speed_rad_per_s);
  s->shaft_rad = (float)inputs->encoder_counts * GAIN(SHAFT_SCALE);
  if (!speed_lost) s->speed_rad_per_s = speed_rad_per_s;
  if (!current_lost) s->current_A = (float)inputs->current_counts * GAIN(CURRENT_SCALE);
  if (!tension_lost) s->tension_N = tension_of(gains, inputs);
  s->rail_ticks = count_consecutive(current_lost || tension_lost || speed_lost, s->rail_ticks);
}

/* ---- checks ---- */

/* Ticks of rotation without a change. At standstill the number is kept, because a reading may then
 * be constant. */
static uint32_t unchanged_ticks(uint32_t ticks, bool same, float speed_rad_per_s,
                                float min_rad_per_s) {
  if (!same || min_rad_per_s <= 0.0f) return 0u;
  return magnitude(speed_rad_per_s) >= min_rad_per_s ? ticks + 1u : ticks;
}

static void check_stuck(ecu_sensed* s, const float* gains, const ecu_inputs* inputs) {
  const bool same_current = inputs->current_counts == s->inputs.current_counts;
  const bool taut = tension_of(gains, inputs) > 0.0f; /* at 0 a clipped reading may be constant */
  const bool same_tension = taut && inputs->tension_counts == s->inputs.tension_counts;
  s->same_current_ticks = unchanged_ticks(s->same_current_ticks, same_current, s->speed_rad_per_s,
                                          GAIN(CURRENT_STUCK_SPEED));
  s->same_tension_ticks = unchanged_ticks(s->same_tension_ticks, same_tension, s->speed_rad_per_s,
                                          GAIN(TENSION_STUCK_SPEED));
}

static void check_encoder(ecu_sensed* s, const float* gains, float applied_V) {
  const float emf_V = applied_V - GAIN(RESISTANCE) * s->current_A;
  const float encoder_emf_V = GAIN(BACK_EMF) * s->speed_rad_per_s;
  const bool turns = magnitude(emf_V) > TURNING_FRACTION * GAIN(RESISTANCE) * GAIN(CURRENT_LIMIT);
  const bool is_not_counted = emf_V > 0.0f ? encoder_emf_V < emf_V * ENCODER_FRACTION
                                           : encoder_emf_V > emf_V * ENCODER_FRACTION;
  s->lag_ticks = count_consecutive(GAIN(BACK_EMF) > 0.0f && turns && is_not_counted, s->lag_ticks);
}

/* Beyond its range a potentiometer reads its end value, which is not used. */
static void check_potentiometer(ecu_sensed* s, const float* gains, const ecu_inputs* inputs) {
  const float counts = (float)inputs->potentiometer_counts;
  if (GAIN(WIPER_TOLERANCE) <= 0.0f || counts <= 0.0f || counts >= GAIN(WIPER_COUNTS_MAX)) {
    s->disagree_ticks = 0u;
    return;
  }
  const float sum_rad = s->shaft_rad + counts * GAIN(WIPER_SCALE);
  if (!s->has_wiper_zero) s->wiper_zero_rad = sum_rad;
  s->has_wiper_zero = true;
  s->disagree_ticks = count_consecutive(
      magnitude(sum_rad - s->wiper_zero_rad) > GAIN(WIPER_TOLERANCE), s->disagree_ticks);
}

static ecu_fault detected_fault(const ecu_sensed* s) {
  if (s->rail_ticks >= ECU_RAIL_TICKS) return ECU_FAULT_SENSOR_RANGE;
  if (s->lag_ticks >= ECU_DISAGREE_TICKS) return ECU_FAULT_ENCODER;
  if (s->disagree_ticks >= ECU_DISAGREE_TICKS) return ECU_FAULT_POTENTIOMETER;
  if (s->same_current_ticks >= ECU_STUCK_TICKS || s->same_tension_ticks >= ECU_STUCK_TICKS)
    return ECU_FAULT_SENSOR_STUCK;
  return ECU_FAULT_NONE;
}

ecu_fault ecu_sense(ecu_sensed* sensed, const float* gains, const ecu_inputs* inputs,
                    float applied_V) {
  convert(sensed, gains, inputs);
  if (sensed->has_inputs) check_stuck(sensed, gains, inputs);
  check_encoder(sensed, gains, applied_V);
  check_potentiometer(sensed, gains, inputs);
  return detected_fault(sensed);
}

void ecu_sensing_clear(ecu_sensed* sensed) {
  sensed->rail_ticks = sensed->same_current_ticks = sensed->same_tension_ticks = 0u;
  sensed->lag_ticks = sensed->disagree_ticks = 0u;
}
