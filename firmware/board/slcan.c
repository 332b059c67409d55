#include "firmware/board/slcan.h"

#define HEADER_BYTES 5u /* t, identifier, size */

static int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

/* Reads `digits` digits. Returns -1 when a character is not a digit. */
static int32_t number_at(const char* text, unsigned digits) {
  int32_t value = 0;
  for (unsigned i = 0; i < digits; ++i) {
    const int digit = digit_of(text[i]);
    if (digit < 0) return -1;
    value = value * 16 + digit;
  }
  return value;
}

static bool read_frame(const slcan_reader* reader, bus_frame* frame) {
  if (reader->length < HEADER_BYTES) return false;
  const int32_t id = number_at(reader->line + 1, 3), size = number_at(reader->line + 4, 1);
  if (id < 0 || id > 0x7FF || size < 0 || size > 8) return false;
  if (reader->length != HEADER_BYTES + 2u * (unsigned)size) return false;
  frame->id = (uint16_t)id;
  frame->size = (uint8_t)size;
  for (unsigned i = 0; i < 8u; ++i) frame->data[i] = 0;
  for (unsigned i = 0; i < frame->size; ++i) {
    const int32_t byte = number_at(reader->line + HEADER_BYTES + 2u * i, 2);
    if (byte < 0) return false;
    frame->data[i] = (uint8_t)byte;
  }
  return true;
}

static slcan_event parse_line(slcan_reader* reader, bus_frame* frame) {
  if (reader->length == 0) return SLCAN_NOTHING;
  if (reader->line[0] == 'O') return SLCAN_OPEN;
  if (reader->line[0] == 'C') return SLCAN_CLOSE;
  if (reader->line[0] != 't') return SLCAN_NOTHING;
  if (!reader->too_long && read_frame(reader, frame)) return SLCAN_FRAME;
  ++reader->unreadable;
  return SLCAN_NOTHING;
}

slcan_event slcan_take(slcan_reader* reader, uint8_t byte, bus_frame* frame) {
  if (byte != '\r') {
    if (reader->length < SLCAN_LINE_MAX) reader->line[reader->length++] = (char)byte;
    else reader->too_long = true;
    return SLCAN_NOTHING;
  }
  const slcan_event event = parse_line(reader, frame);
  reader->length = 0;
  reader->too_long = false;
  return event;
}

static unsigned put_number(char* text, uint32_t value, unsigned digits) {
  for (unsigned i = 0; i < digits; ++i)
    text[i] = "0123456789ABCDEF"[value >> (4u * (digits - 1u - i)) & 15u];
  return digits;
}

unsigned slcan_write(char* text, const bus_frame* frame) {
  unsigned n = 0;
  text[n++] = 't';
  n += put_number(text + n, frame->id, 3);
  n += put_number(text + n, frame->size, 1);
  for (unsigned i = 0; i < frame->size && i < 8u; ++i) n += put_number(text + n, frame->data[i], 2);
  text[n++] = '\r';
  return n;
}
