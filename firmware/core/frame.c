#include "firmware/core/frame.h"

#include <string.h>

#include "firmware/core/bits.h"

/* ---- identifier and check value ---- */

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

static void finish_frame(bus_frame* frame, frame_function function, uint8_t ecu, const cursor* c) {
  frame->id = frame_identifier(function, ecu);
  frame->size = 8;
  for (unsigned i = 0; i < 7; ++i) frame->data[i] = (uint8_t)(c->bits >> (8u * i));
  frame->data[7] = check_value(frame);
}

static bool open_frame(const bus_frame* frame, frame_function low, frame_function high, cursor* c) {
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

/* ---- frames ---- */

void frame_pack_emergency(bus_frame* frame, uint8_t ecu, const frame_emergency* content) {
  cursor c = {0, 0};
  put(&c, 1, content->boot);
  put(&c, 1, content->channel);
  put(&c, 4, content->fault);
  put(&c, 4, content->reset_cause);
  put(&c, 6, content->version);
  put(&c, 32, content->tick);
  finish_frame(frame, FRAME_EMERGENCY, ecu, &c);
}

bool frame_unpack_emergency(const bus_frame* frame, frame_emergency* content) {
  cursor c;
  if (!open_frame(frame, FRAME_EMERGENCY, FRAME_EMERGENCY, &c)) return false;
  content->boot = take_bit(&c);
  content->channel = take8(&c, 1);
  content->fault = take8(&c, 4);
  content->reset_cause = take8(&c, 4);
  content->version = take8(&c, 6);
  content->tick = take(&c, 32);
  return true;
}

void frame_pack_command(bus_frame* frame, uint8_t ecu, const frame_command* content) {
  cursor c = {0, 0};
  for (int k = 0; k < 2; ++k) {
    put(&c, 3, content->channel[k].request);
    put_setpoint(&c, content->channel[k].setpoint);
  }
  put(&c, 3, content->answers);
  put(&c, 3, content->count);
  finish_frame(frame, FRAME_COMMAND, ecu, &c);
}

bool frame_unpack_command(const bus_frame* frame, frame_command* content) {
  cursor c;
  if (!open_frame(frame, FRAME_COMMAND, FRAME_COMMAND, &c)) return false;
  for (int k = 0; k < 2; ++k) {
    content->channel[k].request = take8(&c, 3);
    content->channel[k].setpoint = take_setpoint(&c);
  }
  content->answers = take8(&c, 3);
  content->count = take8(&c, 3);
  return true;
}

void frame_pack_status(bus_frame* frame, uint8_t ecu, uint8_t channel,
                       const frame_status* content) {
  cursor c = {0, 0};
  const bool running = content->state == ECU_STATE_RUNNING;
  put(&c, 16, content->encoder_low);
  put(&c, 12, (uint32_t)saturate(content->current_counts, -2048, 2047));
  put(&c, 12, (uint32_t)saturate(content->tension_counts, 0, 4095));
  put(&c, 1, running);
  if (running) {
    put(&c, 11, (uint32_t)saturate(content->duty, -ECU_DUTY_MAX, ECU_DUTY_MAX));
  } else {
    put(&c, 3, content->state);
    put(&c, 4, content->fault);
    put(&c, 3, content->request);
    put(&c, 1, content->warning);
  }
  put(&c, 1, content->follows);
  put(&c, 3, content->counter);
  finish_frame(frame, channel ? FRAME_STATUS_1 : FRAME_STATUS_0, ecu, &c);
}

bool frame_unpack_status(const bus_frame* frame, frame_status* content) {
  cursor c;
  if (!open_frame(frame, FRAME_STATUS_0, FRAME_STATUS_1, &c)) return false;
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
  const bool valid = s.duty >= -ECU_DUTY_MAX && s.state < ECU_STATE_COUNT;
  if (valid) *content = s;
  return valid;
}

void frame_pack_analog(bus_frame* frame, uint8_t ecu, const frame_analog* content) {
  cursor c = {0, 0};
  put(&c, 1, content->page);
  put(&c, 2, content->present);
  for (int k = 0; k < 2; ++k)
    put(&c, 24, (uint32_t)saturate(content->counts[k], -8388608, 8388607));
  put(&c, 3, content->counter);
  finish_frame(frame, FRAME_ANALOG, ecu, &c);
}

bool frame_unpack_analog(const bus_frame* frame, frame_analog* content) {
  cursor c;
  if (!open_frame(frame, FRAME_ANALOG, FRAME_ANALOG, &c)) return false;
  content->page = take8(&c, 1);
  content->present = take8(&c, 2);
  for (int k = 0; k < 2; ++k) content->counts[k] = take_signed(&c, 24);
  content->counter = take8(&c, 3);
  return true;
}

void frame_pack_health(bus_frame* frame, uint8_t ecu, uint8_t channel,
                       const frame_health* content) {
  cursor c = {0, 0};
  put(&c, 1, content->page);
  put(&c, 3, content->counter);
  if (content->page == 0) {
    put(&c, 32, (uint32_t)content->encoder_counts);
    put(&c, 1, content->warning);
    put(&c, 8, content->lost);
    put(&c, 8, content->corrupt);
    put(&c, 1, content->zero_known);
  } else {
    put(&c, 3, content->request);
    put_setpoint(&c, content->setpoint);
    put(&c, 16, content->rejected);
    put(&c, 8, content->refused_gain_sets);
    put(&c, 3, content->accepted_gain_sets);
  }
  finish_frame(frame, channel ? FRAME_HEALTH_1 : FRAME_HEALTH_0, ecu, &c);
}

bool frame_unpack_health(const bus_frame* frame, frame_health* content) {
  cursor c;
  if (!open_frame(frame, FRAME_HEALTH_0, FRAME_HEALTH_1, &c)) return false;
  *content = (frame_health){.page = take8(&c, 1)};
  content->counter = take8(&c, 3);
  if (content->page == 0) {
    content->encoder_counts = (int32_t)take(&c, 32);
    content->warning = take_bit(&c);
    content->lost = take8(&c, 8);
    content->corrupt = take8(&c, 8);
    content->zero_known = take_bit(&c);
  } else {
    content->request = take8(&c, 3);
    content->setpoint = take_setpoint(&c);
    content->rejected = (uint16_t)take(&c, 16);
    content->refused_gain_sets = take8(&c, 8);
    content->accepted_gain_sets = take8(&c, 3);
  }
  return true;
}

void frame_pack_parameter(bus_frame* frame, uint8_t ecu, const frame_parameter* content) {
  cursor c = {0, 0};
  uint32_t value;
  memcpy(&value, &content->value, sizeof value);
  put(&c, 1, content->channel);
  put(&c, 6, content->index);
  put(&c, 1, content->commit);
  put(&c, 8, content->position);
  put(&c, 32, value);
  finish_frame(frame, FRAME_PARAMETER, ecu, &c);
}

bool frame_unpack_parameter(const bus_frame* frame, frame_parameter* content) {
  cursor c;
  if (!open_frame(frame, FRAME_PARAMETER, FRAME_PARAMETER, &c)) return false;
  content->channel = take8(&c, 1);
  content->index = take8(&c, 6);
  content->commit = take_bit(&c);
  content->position = take8(&c, 8);
  const uint32_t value = take(&c, 32);
  memcpy(&content->value, &value, sizeof value);
  return true;
}

void frame_pack_discover(bus_frame* frame, uint8_t ecu) {
  const cursor c = {0, 0};
  finish_frame(frame, FRAME_DISCOVER, ecu, &c);
}

bool frame_unpack_discover(const bus_frame* frame) {
  cursor c;
  return open_frame(frame, FRAME_DISCOVER, FRAME_DISCOVER, &c);
}

void frame_pack_hello(bus_frame* frame, uint8_t ecu, const frame_hello* content) {
  cursor c = {0, 0};
  put(&c, 6, content->version);
  put(&c, 2, content->channels);
  put(&c, 4, content->analog_inputs);
  put(&c, 4, content->reset_cause);
  put(&c, 24, content->serial);
  finish_frame(frame, FRAME_HELLO, ecu, &c);
}

bool frame_unpack_hello(const bus_frame* frame, frame_hello* content) {
  cursor c;
  if (!open_frame(frame, FRAME_HELLO, FRAME_HELLO, &c)) return false;
  content->version = take8(&c, 6);
  content->channels = take8(&c, 2);
  content->analog_inputs = take8(&c, 4);
  content->reset_cause = take8(&c, 4);
  content->serial = take(&c, 24);
  return true;
}

uint8_t frame_ahead(uint8_t received, uint8_t last) { return (uint8_t)(received - last) & 7u; }

int32_t frame_unwrap(int32_t last, uint16_t low) {
  const int16_t change = (int16_t)(uint16_t)(low - (uint16_t)last);
  return (int32_t)((uint32_t)last + (uint32_t)change);
}
