#include "firmware/core/ecu.h"

#include "firmware/core/state.h"

#define GAIN(channel, id) ((channel)->gains[ECU_PARAMETER_##id])

void ecu_init(ecu_channel* channel) { *channel = (ecu_channel){.state = ECU_STATE_BOOT}; }

void ecu_trip(ecu_channel* channel, ecu_fault fault) {
  const bool was_well = channel->state != ECU_STATE_FAULT;
  ecu_apply(channel, ECU_EVENT_TRIP);
  if (was_well && channel->state == ECU_STATE_FAULT) channel->fault = fault;
}

static bool is_live(const ecu_channel* channel) {
  return channel->state == ECU_STATE_ARMED || channel->state == ECU_STATE_RUNNING;
}

bool ecu_is_warning(const ecu_channel* channel) {
  return is_live(channel) && channel->ticks_since_command >= ECU_WARN_TICKS;
}

/* ---- commands ---- */

/* Within low .. high, give or take half a quantum: what rounds to the limit is not beyond it. */
static bool within(int32_t setpoint, float quantum, float low, float high) {
  const float value = (float)setpoint * quantum, slack = 0.501f * quantum;
  return value >= low - slack && value <= high + slack;
}

static bool is_sane(const ecu_channel* c, ecu_request request, int32_t setpoint) {
  switch (request) {
    case ECU_REQUEST_OFF:
    case ECU_REQUEST_CLEAR:
    case ECU_REQUEST_ARM:
      return true;
    case ECU_REQUEST_VOLTAGE:
      return within(setpoint, 1e-3f, -GAIN(c, SUPPLY), GAIN(c, SUPPLY));
    case ECU_REQUEST_LENGTH:
      return within(setpoint, GAIN(c, SHAFT_SCALE), GAIN(c, SHAFT_MIN), GAIN(c, SHAFT_MAX));
    case ECU_REQUEST_CURRENT:
      return within(setpoint, 1e-3f, -GAIN(c, CURRENT_LIMIT), GAIN(c, CURRENT_LIMIT));
    case ECU_REQUEST_FORCE:
      return within(setpoint, 1e-3f, 0.0f, GAIN(c, TENSION_LIMIT));
  }
  return false;
}

static bool reject(ecu_channel* channel) {
  ++channel->rejected_setpoints;
  if (is_live(channel) && ++channel->bad_setpoints >= ECU_BAD_SETPOINTS_TRIP)
    ecu_trip(channel, ECU_FAULT_SETPOINT);
  return false;
}

/* A law takes over at the voltage that is applied now: 0 after arming. */
static void start_law(ecu_channel* channel, ecu_request request, int32_t setpoint) {
  const float applied_V = GAIN(channel, SUPPLY) * (float)channel->duty / (float)ECU_DUTY_MAX;
  const float error_A = (float)setpoint / 1000.0f - channel->current_A;
  if (request == ECU_REQUEST_CURRENT)
    channel->current_memory =
        (law_current_memory){.integral_V = applied_V, .last_error_A = error_A};
}

static bool follow(ecu_channel* channel, ecu_request request, int32_t setpoint) {
  if (ecu_next_state(channel->state, ECU_EVENT_SETPOINT) != ECU_STATE_RUNNING) {
    ++channel->rejected_setpoints;
    return false;
  }
  if (channel->request != request) start_law(channel, request, setpoint);
  ecu_apply(channel, ECU_EVENT_SETPOINT);
  channel->request = request;
  channel->setpoint = setpoint;
  channel->ticks_since_command = 0;
  channel->bad_setpoints = 0;
  return true;
}

static bool arm(ecu_channel* channel) {
  ecu_apply(channel, ECU_EVENT_ARM);
  if (channel->state != ECU_STATE_ARMED) return false;
  channel->ticks_since_command = 0;
  channel->bad_setpoints = 0;
  return true;
}

bool ecu_command(ecu_channel* channel, ecu_request request, int32_t setpoint) {
  if (channel->gains_complete && !is_sane(channel, request, setpoint)) return reject(channel);
  switch (request) {
    case ECU_REQUEST_OFF:
      ecu_apply(channel, ECU_EVENT_OFF);
      return true;
    case ECU_REQUEST_CLEAR:
      ecu_apply(channel, ECU_EVENT_CLEAR);
      return true;
    case ECU_REQUEST_ARM:
      return arm(channel);
    default:
      return follow(channel, request, setpoint);
  }
}

/* ---- one period ---- */

/* Counts to SI. A reading at a converter's rail says nothing: the last good one stays, until the
 * third in a row trips. Tension 0 is a slack tendon, not a rail. */
static void measure(ecu_channel* c, const ecu_inputs* inputs) {
  const float counts_per_period =
      c->has_inputs
          ? (float)(int32_t)((uint32_t)inputs->encoder_counts - (uint32_t)c->inputs.encoder_counts)
          : 0.0f;
  const float current = (float)inputs->current_counts, tension = (float)inputs->tension_counts;
  const float current_max = GAIN(c, CURRENT_COUNTS_MAX);
  const bool current_at_rail = current >= current_max || current <= -current_max;
  const bool tension_at_rail = tension >= GAIN(c, TENSION_COUNTS_MAX);
  c->shaft_rad = (float)inputs->encoder_counts * GAIN(c, SHAFT_SCALE);
  c->speed_rad_per_s = counts_per_period * GAIN(c, SHAFT_SCALE) / ECU_PERIOD_S;
  if (!current_at_rail) c->current_A = current * GAIN(c, CURRENT_SCALE);
  if (!tension_at_rail) c->tension_N = tension * GAIN(c, TENSION_SCALE);
  c->rail_ticks = current_at_rail || tension_at_rail ? c->rail_ticks + 1u : 0u;
}

/* Over-current is judged on the raw reading: a short drives the converter to its rail. */
static void count_over_current(ecu_channel* c, const ecu_inputs* inputs) {
  const float current_A = (float)inputs->current_counts * GAIN(c, CURRENT_SCALE);
  const float trip_A = GAIN(c, CURRENT_TRIP);
  const bool over = current_A > trip_A || current_A < -trip_A;
  c->over_current_ticks = over ? c->over_current_ticks + 1u : 0u;
}

static void check_limits(ecu_channel* c) {
  if (c->over_current_ticks >= ECU_OVER_CURRENT_TICKS) ecu_trip(c, ECU_FAULT_OVER_CURRENT);
  if (c->tension_N > GAIN(c, TENSION_TRIP)) ecu_trip(c, ECU_FAULT_OVER_TENSION);
  if (c->rail_ticks >= ECU_RAIL_TICKS) ecu_trip(c, ECU_FAULT_SENSOR_RANGE);
}

static void check_timeout(ecu_channel* c) {
  if (!is_live(c)) return;
  if (c->ticks_since_command >= ECU_TIMEOUT_TICKS) ecu_trip(c, ECU_FAULT_COMMAND_TIMEOUT);
  else ++c->ticks_since_command;
}

static float law_V(ecu_channel* c) {
  const float milli = (float)c->setpoint / 1000.0f;
  switch (c->request) {
    case ECU_REQUEST_VOLTAGE:
      return milli;
    case ECU_REQUEST_LENGTH:
      return law_length_V(GAIN(c, LENGTH_KP), (float)c->setpoint * GAIN(c, SHAFT_SCALE),
                          c->shaft_rad);
    case ECU_REQUEST_CURRENT:
      return law_current_V(&c->current_memory, GAIN(c, CURRENT_KP), GAIN(c, CURRENT_KI),
                           GAIN(c, CURRENT_KD), milli - c->current_A, GAIN(c, SUPPLY),
                           ECU_PERIOD_S);
    case ECU_REQUEST_FORCE: {
      const law_force_gains gains = {GAIN(c, FORCE_K_CURRENT), GAIN(c, FORCE_K_SPEED),
                                     GAIN(c, FORCE_K_TENSION), GAIN(c, FORCE_PREFILTER)};
      return law_force_V(&gains, milli, c->current_A, c->speed_rad_per_s, c->tension_N);
    }
    default:
      return 0.0f;
  }
}

/* The law's voltage, limited, to the nearest PWM count; no number is no voltage. */
static int16_t drive(ecu_channel* c) {
  const float voltage_V =
      law_limit_current_V(law_V(c), c->speed_rad_per_s, GAIN(c, RESISTANCE), GAIN(c, BACK_EMF),
                          GAIN(c, CURRENT_LIMIT), GAIN(c, SUPPLY));
  const float counts = voltage_V / GAIN(c, SUPPLY) * (float)ECU_DUTY_MAX;
  if (!(counts >= -(float)ECU_DUTY_MAX && counts <= (float)ECU_DUTY_MAX)) return 0;
  return (int16_t)(counts < 0.0f ? counts - 0.5f : counts + 0.5f);
}

int16_t ecu_tick(ecu_channel* channel, const ecu_inputs* inputs) {
  if (channel->gains_complete) {
    measure(channel, inputs);
    count_over_current(channel, inputs);
    check_limits(channel);
    check_timeout(channel);
  }
  channel->inputs = *inputs;
  channel->has_inputs = true;
  channel->duty = channel->state == ECU_STATE_RUNNING ? drive(channel) : 0;
  return channel->duty;
}
