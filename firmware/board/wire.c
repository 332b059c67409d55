#include "firmware/board/wire.h"

#define WIRE_NONE ((wire_kind)0)
#define SYNC 0xA5u
#define HEADER_BYTES 4u /* sync, kind, size, ecu */
#define READINGS_BYTES (2u + 2u * 12u + 4u * ECU_ANALOG_INPUTS)
#define DRIVE_BYTES 5u
#define FAULT_BYTES 4u
#define SAMPLE_BYTES 2u

/* ---- packing ---- */

typedef struct {
  uint8_t* bytes;
  unsigned size;
} cursor;

static void put(cursor* c, unsigned count, uint32_t value) {
  for (unsigned i = 0; i < count; ++i) c->bytes[c->size++] = (uint8_t)(value >> (8u * i));
}

static cursor begin(uint8_t* bytes, wire_kind kind, unsigned size, uint8_t ecu) {
  cursor c = {bytes, 0};
  put(&c, 1, SYNC);
  put(&c, 1, (uint32_t)kind);
  put(&c, 1, size);
  put(&c, 1, ecu);
  return c;
}

static unsigned end(cursor* c) {
  put(c, 1, frame_crc8(c->bytes + 1, c->size - 1u));
  return c->size;
}

unsigned wire_pack_readings(uint8_t* bytes, uint8_t ecu, const board_readings* readings) {
  cursor c = begin(bytes, WIRE_READINGS, READINGS_BYTES, ecu);
  put(&c, 1, readings->turn);
  for (unsigned k = 0; k < 2; ++k) {
    const ecu_inputs* in = &readings->channel[k];
    put(&c, 4, (uint32_t)in->encoder_counts);
    put(&c, 2, (uint16_t)in->current_counts);
    put(&c, 2, in->tension_counts);
    put(&c, 2, in->temperature_counts);
    put(&c, 2, in->supply_counts);
  }
  for (unsigned k = 0; k < ECU_ANALOG_INPUTS; ++k) put(&c, 4, (uint32_t)readings->analog[k]);
  return end(&c);
}

unsigned wire_pack_drive(uint8_t* bytes, uint8_t ecu, const int16_t* duty) {
  cursor c = begin(bytes, WIRE_DRIVE, DRIVE_BYTES, ecu);
  for (unsigned k = 0; k < 2; ++k) put(&c, 2, (uint16_t)duty[k]);
  return end(&c);
}

unsigned wire_pack_sample(uint8_t* bytes, uint8_t ecu, uint8_t turn) {
  cursor c = begin(bytes, WIRE_SAMPLE, SAMPLE_BYTES, ecu);
  put(&c, 1, turn);
  return end(&c);
}

unsigned wire_pack_fault(uint8_t* bytes, uint8_t ecu, const wire_fault* fault) {
  cursor c = begin(bytes, WIRE_FAULT, FAULT_BYTES, ecu);
  put(&c, 1, fault->kind);
  put(&c, 2, fault->periods);
  return end(&c);
}

/* ---- reading ---- */

static unsigned size_of(uint8_t kind) {
  switch (kind) {
    case WIRE_READINGS:
      return READINGS_BYTES;
    case WIRE_DRIVE:
      return DRIVE_BYTES;
    case WIRE_FAULT:
      return FAULT_BYTES;
    case WIRE_SAMPLE:
      return SAMPLE_BYTES;
    default:
      return 0;
  }
}

static wire_kind discard(wire_reader* reader) {
  ++reader->unreadable;
  reader->length = 0;
  return WIRE_NONE;
}

wire_kind wire_take(wire_reader* reader, uint8_t byte) {
  if (reader->length == 0 && byte != SYNC) return WIRE_NONE;
  reader->bytes[reader->length++] = byte;
  if (reader->length < 3) return WIRE_NONE;
  const unsigned size = size_of(reader->bytes[1]);
  if (size == 0 || reader->bytes[2] != size) return discard(reader);
  if (reader->length < size + 4u) return WIRE_NONE;
  if (frame_crc8(reader->bytes + 1, size + 2u) != byte) return discard(reader);
  reader->length = 0;
  return (wire_kind)reader->bytes[1];
}

static uint32_t get(const uint8_t** position, unsigned count) {
  uint32_t value = 0;
  for (unsigned i = 0; i < count; ++i) value |= (uint32_t) * (*position)++ << (8u * i);
  return value;
}

uint8_t wire_ecu(const wire_reader* reader) { return reader->bytes[3]; }

void wire_unpack_readings(const wire_reader* reader, board_readings* readings) {
  const uint8_t* position = reader->bytes + HEADER_BYTES;
  *readings = (board_readings){0};
  readings->turn = (uint8_t)get(&position, 1);
  for (unsigned k = 0; k < 2; ++k) {
    ecu_inputs* in = &readings->channel[k];
    in->encoder_counts = (int32_t)get(&position, 4);
    in->current_counts = (int16_t)get(&position, 2);
    in->tension_counts = (uint16_t)get(&position, 2);
    in->temperature_counts = (uint16_t)get(&position, 2);
    in->supply_counts = (uint16_t)get(&position, 2);
  }
  for (unsigned k = 0; k < ECU_ANALOG_INPUTS; ++k) readings->analog[k] = (int32_t)get(&position, 4);
}

void wire_count_from_reset(wire_counters* counters, board_readings* readings) {
  for (unsigned k = 0; k < 2; ++k) {
    uint32_t total = (uint32_t)readings->channel[k].encoder_counts;
    if (!counters->started) counters->start_counts[k] = (int32_t)total;
    total -= (uint32_t)counters->start_counts[k];
    readings->channel[k].encoder_counts = (int32_t)total;
  }
  counters->started = true;
}

void wire_unpack_drive(const wire_reader* reader, int16_t* duty) {
  const uint8_t* position = reader->bytes + HEADER_BYTES;
  for (unsigned k = 0; k < 2; ++k) duty[k] = (int16_t)get(&position, 2);
}

uint8_t wire_sample_turn(const wire_reader* reader) { return reader->bytes[4]; }

void wire_unpack_fault(const wire_reader* reader, wire_fault* fault) {
  const uint8_t* position = reader->bytes + HEADER_BYTES;
  fault->kind = (uint8_t)get(&position, 1);
  fault->periods = (uint16_t)get(&position, 2);
}
