/* The gains of a channel: staged one by one, committed as a set. */
#include <float.h>

#include "firmware/core/ecu.h"
#include "firmware/core/state.h"

_Static_assert(ECU_PARAMETER_COUNT < ECU_ZERO, "`written` has one bit per parameter");
static const uint64_t all_written = ((uint64_t)1 << ECU_PARAMETER_COUNT) - 1u;

static bool is_finite(float x) { return x >= -FLT_MAX && x <= FLT_MAX; } /* false for NaN */

/* False for values that make a conversion, a limit or a trip level meaningless, or reverse the sign
 * of a loop. State feedback gains may have either sign: Ackermann's formula determines it. */
static bool is_sane(const float* g) {
  static const uint8_t above_zero[] = {
      ECU_PARAMETER_SUPPLY,        ECU_PARAMETER_SHAFT_SCALE,        ECU_PARAMETER_CURRENT_SCALE,
      ECU_PARAMETER_TENSION_SCALE, ECU_PARAMETER_CURRENT_COUNTS_MAX, ECU_PARAMETER_RESISTANCE,
      ECU_PARAMETER_CURRENT_LIMIT, ECU_PARAMETER_TENSION_COUNTS_MAX, ECU_PARAMETER_TENSION_LIMIT};
  static const uint8_t not_negative[] = {
      ECU_PARAMETER_BACK_EMF,       ECU_PARAMETER_LENGTH_KP,         ECU_PARAMETER_CURRENT_KP,
      ECU_PARAMETER_CURRENT_KI,     ECU_PARAMETER_CURRENT_KD,        ECU_PARAMETER_TENSION_ZERO,
      ECU_PARAMETER_OVERLOAD_LIMIT, ECU_PARAMETER_CURRENT_CONTINUOUS};
  for (unsigned i = 0; i < sizeof above_zero; ++i)
    if (!(g[above_zero[i]] > 0.0f)) return false;
  for (unsigned i = 0; i < sizeof not_negative; ++i)
    if (!(g[not_negative[i]] >= 0.0f)) return false;
  return g[ECU_PARAMETER_CURRENT_TRIP] >= g[ECU_PARAMETER_CURRENT_LIMIT] &&
         g[ECU_PARAMETER_TENSION_TRIP] >= g[ECU_PARAMETER_TENSION_LIMIT] &&
         g[ECU_PARAMETER_SHAFT_MIN] < g[ECU_PARAMETER_SHAFT_MAX] &&
         g[ECU_PARAMETER_TENSION_ZERO] < g[ECU_PARAMETER_TENSION_COUNTS_MAX] &&
         (g[ECU_PARAMETER_TEMPERATURE_SCALE] == 0.0f ||
          g[ECU_PARAMETER_TEMPERATURE_DERATE] < g[ECU_PARAMETER_TEMPERATURE_TRIP]);
}

static void copy(float* to, const float* from) {
  for (unsigned i = 0; i < ECU_PARAMETER_COUNT; ++i) to[i] = from[i];
}

void ecu_discard_parameters(ecu_channel* channel) {
  copy(channel->gains_staged, channel->gains);
  channel->written = channel->gains_complete ? all_written : 0u;
  channel->staged_invalid = false;
}

void ecu_invalidate_staged(ecu_channel* channel) { channel->staged_invalid = true; }

static bool commit_staged(ecu_channel* channel) {
  const bool is_complete = !channel->staged_invalid && channel->written == all_written;
  if (!is_complete || !is_sane(channel->gains_staged)) {
    ecu_discard_parameters(channel);
    ++channel->rejected_commits;
    return false;
  }
  copy(channel->gains, channel->gains_staged);
  channel->gains_complete = true;
  ++channel->accepted_commits;
  ecu_apply(channel, ECU_EVENT_COMMIT);
  return true;
}

static bool set_zero(ecu_channel* channel, float value) {
  if (value >= -(float)ECU_ZERO_MAX && value <= (float)ECU_ZERO_MAX)
    return ecu_set_zero(channel, true, (int32_t)value);
  return !is_finite(value) && ecu_set_zero(channel, false, 0);
}

bool ecu_parameter(ecu_channel* channel, uint8_t index, float value, bool commit) {
  if (index == ECU_ZERO) return set_zero(channel, value);
  const bool is_valid = index < ECU_PARAMETER_COUNT && is_finite(value);
  if (is_valid) {
    channel->gains_staged[index] = value;
    channel->written |= (uint64_t)1 << index;
  } else {
    ecu_invalidate_staged(channel);
  }
  if (commit) return commit_staged(channel);
  return is_valid && !channel->staged_invalid;
}
