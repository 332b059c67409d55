#include "firmware/core/ecu.h"

#include "firmware/core/state.h"

#define GAIN(channel, id) ((channel)->gains[ECU_PARAMETER_##id])

void ecu_init(ecu_channel* channel) { *channel = (ecu_channel){.state = ECU_STATE_BOOT}; }

void ecu_trip(ecu_channel* channel, ecu_fault fault) {
  const bool was_fault_free = channel->state != ECU_STATE_FAULT;
  ecu_apply(channel, ECU_EVENT_TRIP);
  if (was_fault_free && channel->state == ECU_STATE_FAULT) channel->fault = fault;
}

static bool is_live(const ecu_channel* channel) {
  return channel->state == ECU_STATE_ARMED || channel->state == ECU_STATE_RUNNING;
}

bool ecu_is_warning(const ecu_channel* channel) {
  return is_live(channel) && channel->ticks_since_command >= ECU_WARN_TICKS;
}

void ecu_overran(ecu_channel* channel, bool overran) {
  if (overran) ++channel->overruns;
  channel->consecutive_overruns = overran ? channel->consecutive_overruns + 1u : 0u;
  if (channel->consecutive_overruns >= ECU_OVERRUNS_TRIP) ecu_trip(channel, ECU_FAULT_OVERRUN);
}

/* ---- commands ---- */

/* True if the set-point is within low .. high, with half a quantization step of tolerance: a value
 * that rounds to the limit is accepted. */
static bool is_within(int32_t setpoint, float step, float low, float high) {
  const float value = (float)setpoint * step, tolerance = 0.501f * step;
  return value >= low - tolerance && value <= high + tolerance;
}

static bool is_sane(const ecu_channel* c, ecu_request request, int32_t setpoint) {
  switch (request) {
    case ECU_REQUEST_OFF:
    case ECU_REQUEST_CLEAR:
    case ECU_REQUEST_ARM:
      return true;
    case ECU_REQUEST_VOLTAGE:
      return is_within(setpoint, 1e-3f, -GAIN(c, SUPPLY), GAIN(c, SUPPLY));
    case ECU_REQUEST_LENGTH:
      return is_within(setpoint, GAIN(c, SHAFT_SCALE), GAIN(c, SHAFT_MIN), GAIN(c, SHAFT_MAX));
    case ECU_REQUEST_CURRENT:
      return is_within(setpoint, 1e-3f, -GAIN(c, CURRENT_LIMIT), GAIN(c, CURRENT_LIMIT));
    case ECU_REQUEST_FORCE:
      return is_within(setpoint, 1e-3f, 0.0f, GAIN(c, TENSION_LIMIT));
  }
  return false;
}

static bool reject(ecu_channel* channel) {
  ++channel->rejected_setpoints;
  if (is_live(channel) && ++channel->bad_setpoints >= ECU_BAD_SETPOINTS_TRIP)
    ecu_trip(channel, ECU_FAULT_SETPOINT);
  return false;
}

static float applied_V(const ecu_channel* c) {
  return GAIN(c, SUPPLY) * (float)c->duty / (float)ECU_DUTY_MAX;
}

/* A new law starts at the currently applied voltage: 0 after arming. */
static void start_law(ecu_channel* channel, ecu_request request, int32_t setpoint) {
  const float error_A = (float)setpoint / 1000.0f - channel->sensed.current_A;
  if (request == ECU_REQUEST_CURRENT)
    channel->current_memory =
        (law_current_memory){.integral_V = applied_V(channel), .last_error_A = error_A};
}

static bool accept_setpoint(ecu_channel* channel, ecu_request request, int32_t setpoint) {
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

/* A delayed clear that refers to another fault has no effect. */
static bool clear(ecu_channel* channel, int32_t fault) {
  if (channel->state == ECU_STATE_FAULT && fault != (int32_t)channel->fault) return false;
  ecu_apply(channel, ECU_EVENT_CLEAR);
  return true;
}

bool ecu_command(ecu_channel* channel, ecu_request request, int32_t setpoint) {
  if (channel->gains_complete && !is_sane(channel, request, setpoint)) return reject(channel);
  switch (request) {
    case ECU_REQUEST_OFF:
      ecu_apply(channel, ECU_EVENT_OFF);
      return true;
    case ECU_REQUEST_CLEAR:
      return clear(channel, setpoint);
    case ECU_REQUEST_ARM:
      return arm(channel);
    default:
      return accept_setpoint(channel, request, setpoint);
  }
}

/* ---- the encoder's zero ---- */

static int32_t add_counts(int32_t a, int32_t b) { return (int32_t)((uint32_t)a + (uint32_t)b); }

bool ecu_set_zero(ecu_channel* channel, bool known, int32_t counts) {
  if (channel->state == ECU_STATE_RUNNING && channel->request == ECU_REQUEST_LENGTH) return false;
  ecu_sensed* s = &channel->sensed;
  const int32_t change = (int32_t)((uint32_t)counts - (uint32_t)channel->zero_counts);
  const float change_rad = (float)change * GAIN(channel, SHAFT_SCALE);
  channel->zero_known = known;
  channel->zero_counts = counts;
  s->inputs.encoder_counts = add_counts(s->inputs.encoder_counts, change);
  s->shaft_rad += change_rad;
  s->wiper_zero_rad += change_rad;
  return true;
}

/* ---- one period ---- */

static void trip_if(ecu_channel* c, ecu_fault fault) {
  if (fault != ECU_FAULT_NONE) ecu_trip(c, fault);
}

static void check_timeout(ecu_channel* c) {
  if (!is_live(c)) return;
  if (c->ticks_since_command >= ECU_TIMEOUT_TICKS) ecu_trip(c, ECU_FAULT_COMMAND_TIMEOUT);
  else ++c->ticks_since_command;
}

static float law_V(ecu_channel* c) {
  const float setpoint = (float)c->setpoint / 1000.0f;
  switch (c->request) {
    case ECU_REQUEST_VOLTAGE:
      return setpoint; /* V */
    case ECU_REQUEST_LENGTH:
      return law_length_V(GAIN(c, LENGTH_KP), (float)c->setpoint * GAIN(c, SHAFT_SCALE),
                          c->sensed.shaft_rad);
    case ECU_REQUEST_CURRENT:
      return law_current_V(&c->current_memory, GAIN(c, CURRENT_KP), GAIN(c, CURRENT_KI),
                           GAIN(c, CURRENT_KD), setpoint - c->sensed.current_A, GAIN(c, SUPPLY),
                           ECU_PERIOD_S);
    case ECU_REQUEST_FORCE: {
      const law_force_gains gains = {GAIN(c, FORCE_K_CURRENT), GAIN(c, FORCE_K_SPEED),
                                     GAIN(c, FORCE_K_TENSION), GAIN(c, FORCE_PREFILTER)};
      return law_force_V(&gains, setpoint, c->sensed.current_A, c->sensed.speed_rad_per_s,
                         c->sensed.tension_N);
    }
    default:
      return 0.0f;
  }
}

/* The law's voltage, limited and rounded to PWM counts; 0 if it is not a number. */
static int16_t drive(ecu_channel* c) {
  const float voltage_V = law_limit_current_V(
      law_V(c), c->sensed.speed_rad_per_s, GAIN(c, RESISTANCE), GAIN(c, BACK_EMF),
      ecu_current_limit_A(c->gains, &c->sensed.inputs), GAIN(c, SUPPLY));
  const float counts = voltage_V / GAIN(c, SUPPLY) * (float)ECU_DUTY_MAX;
  if (!(counts >= -(float)ECU_DUTY_MAX && counts <= (float)ECU_DUTY_MAX)) return 0;
  return (int16_t)(counts < 0.0f ? counts - 0.5f : counts + 0.5f);
}

int16_t ecu_tick(ecu_channel* channel, const ecu_inputs* converters) {
  ecu_inputs inputs = *converters;
  inputs.encoder_counts = add_counts(inputs.encoder_counts, channel->zero_counts);
  if (channel->gains_complete) {
    const ecu_fault sensor =
        ecu_sense(&channel->sensed, channel->gains, &inputs, applied_V(channel));
    trip_if(channel, ecu_strain_tick(&channel->strain, channel->gains, &channel->sensed, &inputs));
    trip_if(channel, sensor);
    check_timeout(channel);
  }
  channel->sensed.inputs = inputs;
  channel->sensed.has_inputs = true;
  channel->duty = channel->state == ECU_STATE_RUNNING ? drive(channel) : 0;
  return channel->duty;
}
