/* Converters and PWM of an ECU whose motors are simulated: messages over a serial line or in
 * datagrams replace the voltages on its pins.
 *
 *   0xA5, kind 8, size 8, payload, CRC-8 over kind, size and payload; numbers little endian
 *
 *   READINGS  1  robot -> ECU  ecu 8, turn 8; per channel: encoder 32, current 16,
 *                              tension 16, temperature 16, supply 16; four analog inputs of 32
 *   DRIVE     2  ECU -> robot  ecu 8; duty 16, duty 16: both PWM outputs
 *   FAULT     3  robot -> ECU  ecu 8, kind 8, periods 16: a fault injected by a test
 *   SAMPLE    4  ECU -> robot  ecu 8, turn 8 of the ECU's last readings. Request for readings. The
 *                              answer is READINGS of each later period, at least of the next one.
 *                              If the ECU has no readings or outdated ones, it is the current
 *                              readings. In lockstep it is sent when all ECUs have sent a SAMPLE
 *
 * A byte that is not part of a valid message is skipped; the next 0xA5 starts a new message.
 */
#ifndef ERP_FIRMWARE_WIRE_H
#define ERP_FIRMWARE_WIRE_H
#include "firmware/board/board.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WIRE_PAYLOAD_MAX 48u
#define WIRE_MESSAGE_MAX (WIRE_PAYLOAD_MAX + 4u)

typedef enum { WIRE_READINGS = 1, WIRE_DRIVE = 2, WIRE_FAULT = 3, WIRE_SAMPLE = 4 } wire_kind;

/* Faults that a test injects into an ECU program; the board simulates them. */
typedef enum {
  WIRE_FAULT_HANG = 1,   /* an endless loop */
  WIRE_FAULT_BUSY = 2,   /* each of the next `periods` computes for longer than a period */
  WIRE_FAULT_BUS_OFF = 3 /* the CAN controller is in bus-off for this number of periods */
} wire_fault_kind;

typedef struct {
  uint8_t kind; /* wire_fault_kind */
  uint16_t periods;
} wire_fault;

/* The quadrature counters of a board count from 0 at its reset; the robot sends the shaft's total
 * count. Initialize to zero at the reset. */
typedef struct {
  bool started;
  int32_t start_counts[2];
} wire_counters;
/* Replaces the total counts of `readings` by those since the reset. */
void wire_count_from_reset(wire_counters* counters, board_readings* readings);

/* Packing returns the number of bytes written, at most WIRE_MESSAGE_MAX. */
unsigned wire_pack_readings(uint8_t* bytes, uint8_t ecu, const board_readings* readings);
unsigned wire_pack_drive(uint8_t* bytes, uint8_t ecu, const int16_t* duty);
unsigned wire_pack_sample(uint8_t* bytes, uint8_t ecu, uint8_t turn);
unsigned wire_pack_fault(uint8_t* bytes, uint8_t ecu, const wire_fault* fault);

/* The part of a message read so far. Initialize to zero. */
typedef struct {
  uint8_t bytes[WIRE_MESSAGE_MAX];
  uint8_t length;
  uint32_t unreadable; /* messages with a wrong check value or an unknown kind */
} wire_reader;

/* Processes one byte. Returns the kind of the message that the byte completes, or 0. */
wire_kind wire_take(wire_reader* reader, uint8_t byte);

/* Address and contents of the message just completed. */
uint8_t wire_ecu(const wire_reader* reader);
void wire_unpack_readings(const wire_reader* reader, board_readings* readings);
void wire_unpack_drive(const wire_reader* reader, int16_t* duty);
uint8_t wire_sample_turn(const wire_reader* reader);
void wire_unpack_fault(const wire_reader* reader, wire_fault* fault);

#ifdef __cplusplus
}
#endif
#endif
