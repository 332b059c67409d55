/* Converters and PWM of an ECU whose motors are simulated: what would be voltages on its pins comes
 * as messages over a serial line or in datagrams.
 *
 *   0xA5, kind 8, size 8, payload, CRC-8 over kind, size and payload; numbers little endian
 *
 *   READINGS  1  robot -> ECU  ecu 8, turn 8; per channel: encoder 32, current 16,
 *                              tension 16, temperature 16, supply 16; four analog inputs of 32
 *   DRIVE     2  ECU -> robot  ecu 8; duty 16, duty 16: both PWM outputs
 *   MISHAP    3  robot -> ECU  ecu 8, kind 8, periods 16: what tests do to it
 *   SAMPLE    4  ECU -> robot  ecu 8, turn 8 of the readings it has: answered by READINGS of each
 *                              period since those, the next one at least; by those of now if there
 *                              are none or they are too old; in lockstep when all have asked
 *
 * A byte that makes no sense is passed over; the next 0xA5 begins again.
 */
#ifndef ERP_FIRMWARE_WIRE_H
#define ERP_FIRMWARE_WIRE_H
#include "firmware/board/board.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WIRE_PAYLOAD_MAX 48u
#define WIRE_MESSAGE_MAX (WIRE_PAYLOAD_MAX + 4u)

typedef enum { WIRE_READINGS = 1, WIRE_DRIVE = 2, WIRE_MISHAP = 3, WIRE_SAMPLE = 4 } wire_kind;

/* What can befall a program; the board brings it about. */
typedef enum {
  WIRE_MISHAP_HANG = 1,   /* an endless loop */
  WIRE_MISHAP_BUSY = 2,   /* each of the next periods works for longer than a period */
  WIRE_MISHAP_BUS_OFF = 3 /* the CAN controller is off the bus for so many periods */
} wire_mishap_kind;

typedef struct {
  uint8_t kind; /* wire_mishap_kind */
  uint16_t periods;
} wire_mishap;

/* Packing returns how many bytes were written, at most WIRE_MESSAGE_MAX. */
unsigned wire_pack_readings(uint8_t* bytes, uint8_t ecu, const board_readings* readings);
unsigned wire_pack_drive(uint8_t* bytes, uint8_t ecu, const int16_t* duty);
unsigned wire_pack_sample(uint8_t* bytes, uint8_t ecu, uint8_t turn);
unsigned wire_pack_mishap(uint8_t* bytes, uint8_t ecu, const wire_mishap* mishap);

/* What has been read of a message so far. Zero it first. */
typedef struct {
  uint8_t bytes[WIRE_MESSAGE_MAX];
  uint8_t have;
  uint32_t unreadable; /* messages with a wrong check value or of no known kind */
} wire_reader;

/* Takes one byte. Returns the kind of the message it ends, or 0. */
wire_kind wire_take(wire_reader* reader, uint8_t byte);

/* Of the message just ended: whose it is, and what it says. */
uint8_t wire_ecu(const wire_reader* reader);
void wire_unpack_readings(const wire_reader* reader, board_readings* readings);
void wire_unpack_drive(const wire_reader* reader, int16_t* duty);
uint8_t wire_sample_turn(const wire_reader* reader);
void wire_unpack_mishap(const wire_reader* reader, wire_mishap* mishap);

#ifdef __cplusplus
}
#endif
#endif
