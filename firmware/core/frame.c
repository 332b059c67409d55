#include "firmware/core/frame.h"

#include <string.h>

/* ---- envelope ---- */

uint16_t frame_identifier(frame_function function, uint8_t ecu) {
  return (uint16_t)((unsigned)function << 7 | (ecu & 0x7Fu));
}
frame_function frame_function_of(const bus_frame* frame) {
  return (frame_function)(frame->id >> 7 & 0xFu);
}
uint8_t frame_ecu_of(const bus_frame* frame) { return frame->id & 0x7Fu; }

uint8_t frame_crc8(const uint8_t* bytes, unsigned count) {
  uint8_t crc = 0xFF;
  for (unsigned i = 0; i < count; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit)
      crc = (uint8_t)(crc & 0x80u ? (unsigned)crc << 1 ^ 0x2Fu : (unsigned)crc << 1);
  }
  return crc ^ 0xFFu;
}

static uint8_t check_value(const bus_frame* frame) {
  uint8_t bytes[9] = {(uint8_t)(frame->id & 0xFFu), (uint8_t)(frame->id >> 8)};
  memcpy(bytes + 2, frame->data, 7);
  return frame_crc8(bytes, sizeof bytes);
}

bool frame_is_intact(const bus_frame* frame) {
  return frame->size == 8 && frame->id <= 0x7FFu && frame->data[7] == check_value(frame);
}

/* ---- bit fields: a cursor over the 56 bits before the check value ---- */

typedef struct {
  uint64_t bits;
  unsigned at;
} cursor;

static void put(cursor* c, unsigned width, uint32_t value) {
  const uint64_t mask = ((uint64_t)1 << width) - 1u;
  c->bits |= (value & mask) << c->at;
  c->at += width;
}
static uint32_t take(cursor* c, unsigned width) {
  const uint64_t mask = ((uint64_t)1 << width) - 1u;
  const uint32_t value = (uint32_t)(c->bits >> c->at & mask);
  c->at += width;
  return value;
}
static uint8_t take8(cursor* c, unsigned width) { return (uint8_t)take(c, width); }
static bool take_bit(cursor* c) { return take(c, 1) != 0; }
static int32_t take_signed(cursor* c, unsigned width) {
  const uint32_t sign = (uint32_t)1 << (width - 1);
  return (int32_t)((take(c, width) ^ sign) - sign);
}

static int32_t saturate(int32_t value, int32_t low, int32_t high) {
  return value < low ? low : value > high ? high : value;
}

static void seal(bus_frame* frame, frame_function function, uint8_t ecu, const cursor* c) {
  frame->id = frame_identifier(function, ecu);
  frame->size = 8;
  for (unsigned i = 0; i < 7; ++i) frame->data[i] = (uint8_t)(c->bits >> (8u * i));
  frame->data[7] = check_value(frame);
}

static bool unseal(const bus_frame* frame, frame_function low, frame_function high, cursor* c) {
  const frame_function function = frame_function_of(frame);
  if (!frame_is_intact(frame) || function < low || function > high) return false;
  *c = (cursor){0, 0};
  for (unsigned i = 0; i < 7; ++i) c->bits |= (uint64_t)frame->data[i] << (8u * i);
  return true;
}

/* ---- set-points: 22 bits, the lowest number reserved ---- */

static void put_setpoint(cursor* c, int32_t setpoint) {
  const bool fits = setpoint >= -FRAME_SETPOINT_MAX && setpoint <= FRAME_SETPOINT_MAX;
  put(c, 22, (uint32_t)(fits ? setpoint : -FRAME_SETPOINT_MAX - 1));
}
static int32_t take_setpoint(cursor* c) {
  const int32_t setpoint = take_signed(c, 22);
  return setpoint < -FRAME_SETPOINT_MAX ? FRAME_SETPOINT_REFUSED : setpoint;
}

/* ---- the frames ---- */

void frame_pack_emergency(bus_frame* frame, uint8_t ecu, const frame_emergency* said) {
  cursor c = {0, 0};
  put(&c, 1, said->boot);
  put(&c, 1, said->channel);
  put(&c, 4, said->fault);
  put(&c, 4, said->reset_cause);
  put(&c, 6, said->version);
  put(&c, 32, said->tick);
  seal(frame, FRAME_EMERGENCY, ecu, &c);
}

bool frame_unpack_emergency(const bus_frame* frame, frame_emergency* said) {
  cursor c;
  if (!unseal(frame, FRAME_EMERGENCY, FRAME_EMERGENCY, &c)) return false;
  said->boot = take_bit(&c);
  said->channel = take8(&c, 1);
  said->fault = take8(&c, 4);
  said->reset_cause = take8(&c, 4);
  said->version = take8(&c, 6);
  said->tick = take(&c, 32);
  return true;
}

void frame_pack_command(bus_frame* frame, uint8_t ecu, const frame_command* said) {
  cursor c = {0, 0};
  for (int k = 0; k < 2; ++k) {
    put(&c, 3, said->channel[k].request);
    put_setpoint(&c, said->channel[k].setpoint);
  }
  put(&c, 3, said->answers);
  put(&c, 3, said->count);
  seal(frame, FRAME_COMMAND, ecu, &c);
}

bool frame_unpack_command(const bus_frame* frame, frame_command* said) {
  cursor c;
  if (!unseal(frame, FRAME_COMMAND, FRAME_COMMAND, &c)) return false;
  for (int k = 0; k < 2; ++k) {
    said->channel[k].request = take8(&c, 3);
    said->channel[k].setpoint = take_setpoint(&c);
  }
  said->answers = take8(&c, 3);
  said->count = take8(&c, 3);
  return true;
}

void frame_pack_status(bus_frame* frame, uint8_t ecu, uint8_t channel, const frame_status* said) {
  cursor c = {0, 0};
  const bool running = said->state == ECU_STATE_RUNNING;
  put(&c, 16, said->encoder_low);
  put(&c, 12, (uint32_t)saturate(said->current_counts, -2048, 2047));
  put(&c, 12, (uint32_t)saturate(said->tension_counts, 0, 4095));
  put(&c, 1, running);
  if (running) {
    put(&c, 11, (uint32_t)saturate(said->duty, -ECU_DUTY_MAX, ECU_DUTY_MAX));
  } else {
    put(&c, 3, said->state);
    put(&c, 4, said->fault);
    put(&c, 3, said->request);
    put(&c, 1, said->warning);
  }
  put(&c, 1, said->follows);
  put(&c, 3, said->counter);
  seal(frame, channel ? FRAME_STATUS_1 : FRAME_STATUS_0, ecu, &c);
}

bool frame_unpack_status(const bus_frame* frame, frame_status* said) {
  cursor c;
  if (!unseal(frame, FRAME_STATUS_0, FRAME_STATUS_1, &c)) return false;
  frame_status s = {.encoder_low = (uint16_t)take(&c, 16)};
  s.current_counts = (int16_t)take_signed(&c, 12);
  s.tension_counts = (uint16_t)take(&c, 12);
  if (take_bit(&c)) {
    s.state = ECU_STATE_RUNNING;
    s.duty = (int16_t)take_signed(&c, 11);
    s.request = FRAME_REQUEST_NONE;
  } else {
    s.state = take8(&c, 3);
    s.fault = take8(&c, 4);
    s.request = take8(&c, 3);
    s.warning = take_bit(&c);
  }
  s.follows = take_bit(&c);
  s.counter = take8(&c, 3);
  const bool meant = s.duty >= -ECU_DUTY_MAX && s.state < ECU_STATE_COUNT;
  if (meant) *said = s;
  return meant;
}

void frame_pack_analog(bus_frame* frame, uint8_t ecu, const frame_analog* said) {
  cursor c = {0, 0};
  put(&c, 1, said->page);
  put(&c, 2, said->present);
  for (int k = 0; k < 2; ++k) put(&c, 24, (uint32_t)saturate(said->counts[k], -8388608, 8388607));
  put(&c, 3, said->counter);
  seal(frame, FRAME_ANALOG, ecu, &c);
}

bool frame_unpack_analog(const bus_frame* frame, frame_analog* said) {
  cursor c;
  if (!unseal(frame, FRAME_ANALOG, FRAME_ANALOG, &c)) return false;
  said->page = take8(&c, 1);
  said->present = take8(&c, 2);
  for (int k = 0; k < 2; ++k) said->counts[k] = take_signed(&c, 24);
  said->counter = take8(&c, 3);
  return true;
}

void frame_pack_health(bus_frame* frame, uint8_t ecu, uint8_t channel, const frame_health* said) {
  cursor c = {0, 0};
  put(&c, 1, said->page);
  put(&c, 3, said->counter);
  if (said->page == 0) {
    put(&c, 32, (uint32_t)said->encoder_counts);
    put(&c, 1, said->warning);
    put(&c, 8, said->lost);
    put(&c, 8, said->corrupt);
  } else {
    put(&c, 3, said->request);
    put_setpoint(&c, said->setpoint);
    put(&c, 16, said->rejected);
    put(&c, 8, said->refused_gain_sets);
  }
  seal(frame, channel ? FRAME_HEALTH_1 : FRAME_HEALTH_0, ecu, &c);
}

bool frame_unpack_health(const bus_frame* frame, frame_health* said) {
  cursor c;
  if (!unseal(frame, FRAME_HEALTH_0, FRAME_HEALTH_1, &c)) return false;
  *said = (frame_health){.page = take8(&c, 1)};
  said->counter = take8(&c, 3);
  if (said->page == 0) {
    said->encoder_counts = (int32_t)take(&c, 32);
    said->warning = take_bit(&c);
    said->lost = take8(&c, 8);
    said->corrupt = take8(&c, 8);
  } else {
    said->request = take8(&c, 3);
    said->setpoint = take_setpoint(&c);
    said->rejected = (uint16_t)take(&c, 16);
    said->refused_gain_sets = take8(&c, 8);
  }
  return true;
}

void frame_pack_parameter(bus_frame* frame, uint8_t ecu, const frame_parameter* said) {
  cursor c = {0, 0};
  uint32_t value;
  memcpy(&value, &said->value, sizeof value);
  put(&c, 1, said->channel);
  put(&c, 6, said->index);
  put(&c, 1, said->commit);
  put(&c, 8, said->position);
  put(&c, 32, value);
  seal(frame, FRAME_PARAMETER, ecu, &c);
}

bool frame_unpack_parameter(const bus_frame* frame, frame_parameter* said) {
  cursor c;
  if (!unseal(frame, FRAME_PARAMETER, FRAME_PARAMETER, &c)) return false;
  said->channel = take8(&c, 1);
  said->index = take8(&c, 6);
  said->commit = take_bit(&c);
  said->position = take8(&c, 8);
  const uint32_t value = take(&c, 32);
  memcpy(&said->value, &value, sizeof value);
  return true;
}

void frame_pack_discover(bus_frame* frame, uint8_t ecu) {
  const cursor c = {0, 0};
  seal(frame, FRAME_DISCOVER, ecu, &c);
}

bool frame_unpack_discover(const bus_frame* frame) {
  cursor c;
  return unseal(frame, FRAME_DISCOVER, FRAME_DISCOVER, &c);
}

void frame_pack_hello(bus_frame* frame, uint8_t ecu, const frame_hello* said) {
  cursor c = {0, 0};
  put(&c, 6, said->version);
  put(&c, 2, said->channels);
  put(&c, 4, said->analog_inputs);
  put(&c, 4, said->reset_cause);
  put(&c, 24, said->serial);
  seal(frame, FRAME_HELLO, ecu, &c);
}

bool frame_unpack_hello(const bus_frame* frame, frame_hello* said) {
  cursor c;
  if (!unseal(frame, FRAME_HELLO, FRAME_HELLO, &c)) return false;
  said->version = take8(&c, 6);
  said->channels = take8(&c, 2);
  said->analog_inputs = take8(&c, 4);
  said->reset_cause = take8(&c, 4);
  said->serial = take(&c, 24);
  return true;
}

uint8_t frame_ahead(uint8_t heard, uint8_t last) { return (uint8_t)(heard - last) & 7u; }

int32_t frame_unwrap(int32_t last, uint16_t low) {
  const int16_t moved = (int16_t)(uint16_t)(low - (uint16_t)last);
  return (int32_t)((uint32_t)last + (uint32_t)moved);
}
