/* Bit fields of a frame, packed from bit 0 of byte 0: a cursor over the 56 bits before the check
 * value. Included by frame.c only. */
#ifndef ERP_FIRMWARE_BITS_H
#define ERP_FIRMWARE_BITS_H
#include <stdbool.h>
#include <stdint.h>

typedef struct {
  uint64_t bits;
  unsigned bit_count;
} cursor;

static inline void put(cursor* c, unsigned width, uint32_t value) {
  const uint64_t mask = ((uint64_t)1 << width) - 1u;
  c->bits |= (value & mask) << c->bit_count;
  c->bit_count += width;
}
static inline uint32_t take(cursor* c, unsigned width) {
  const uint64_t mask = ((uint64_t)1 << width) - 1u;
  const uint32_t value = (uint32_t)(c->bits >> c->bit_count & mask);
  c->bit_count += width;
  return value;
}
static inline uint8_t take8(cursor* c, unsigned width) { return (uint8_t)take(c, width); }
static inline bool take_bit(cursor* c) { return take(c, 1) != 0; }
static inline int32_t take_signed(cursor* c, unsigned width) {
  const uint32_t sign = (uint32_t)1 << (width - 1);
  return (int32_t)((take(c, width) ^ sign) - sign);
}

static inline int32_t saturate(int32_t value, int32_t low, int32_t high) {
  return value < low ? low : value > high ? high : value;
}
#endif
