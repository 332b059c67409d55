/* The frames between ECUs and host on CAN: classic frames, 11-bit identifiers, 8 bytes. Only this
 * file and frame.c define their layout.
 *
 *   identifier = function (4 bits) << 7 | ecu (7 bits); the lower number has priority on the bus
 *
 * Bit fields are little endian, packed in the order given from bit 0 of byte 0; byte 7 is CRC-8
 * (polynomial 0x2F, start and final XOR 0xFF: AUTOSAR's CRC8H2F, Hamming distance 4 at this
 * length) over the identifier's two bytes, low first, and bytes 0..6. A frame of another size or
 * with another check value is corrupt and is ignored. (s) marks a signed field.
 *
 *   EMERGENCY  1     ECU -> host  kind 1, channel 1, fault 4, reset cause 4, version 6, tick 32
 *   COMMAND    2     host -> ECU  request 3, set-point 22 (s); the same for channel 1;
 *                                 answers 3, count 3
 *   STATUS     3, 4  ECU -> host  channel 0, channel 1: encoder 16, current 12 (s), tension 12,
 *                                 running 1, 11 bits that depend on it, follows 1, counter 3
 *                                   running:     duty 11 (s)
 *                                   not running: state 3, fault 4, request 3, warning 1
 *   ANALOG     5     ECU -> host  page 1, present 2, counts 24 (s), counts 24 (s), counter 3
 *   HEALTH     6, 7  ECU -> host  channel 0, channel 1: page 1, counter 3, then
 *                                   page 0:  encoder 32, warning 1, lost 8, corrupt 8,
 *                                            zero known 1
 *                                   page 1:  request 3, set-point 22 (s), rejected 16,
 *                                            refused gain sets 8, accepted gain sets 3
 *   PARAMETER  8     host -> ECU  channel 1, index 6, commit 1, position 8, float32; index ECU_ZERO
 *                                 sets the encoder's zero and is not part of a set
 *   DISCOVER   9     host -> ECU  no data; to one address, or to 127: all ECUs
 *   HELLO      10    ECU -> host  version 6, channels 2, analog inputs 4, reset cause 4, serial 24
 *
 * Counters. An ECU increments its counter every period, modulo 8; all its frames of that period
 * carry it. COMMANDs to an ECU are also counted modulo 8, so that a delayed or repeated command
 * neither takes effect nor resets the command timeout. `answers` in a COMMAND is the counter of the
 * newest STATUS that the command was computed from; lockstep uses it to match commands with ticks.
 *
 * In every state except running the duty is 0, so its bits carry the state: boot and fault codes
 * need no frame of their own. EMERGENCY reports a fault at once, with the highest priority; a boot
 * is reported by EMERGENCY only. The upper half of the encoder count is sent in HEALTH; the
 * receiver unwraps the lower half, which is correct while a channel turns less than 32768 counts
 * between two received frames.
 */
#ifndef ERP_FIRMWARE_FRAME_H
#define ERP_FIRMWARE_FRAME_H
#include <stdbool.h>
#include <stdint.h>

#include "firmware/core/ecu.h"

#ifdef __cplusplus
extern "C" {
#endif

#define FRAME_VERSION 5u
#define FRAME_ECUS 127u                  /* addresses 0 .. 126 */
#define FRAME_EVERYONE 127u              /* address of a DISCOVER that all ECUs answer */
#define FRAME_SETPOINT_MAX 2097151       /* 22 bits signed; -2097152 is reserved: */
#define FRAME_SETPOINT_REFUSED INT32_MIN /* a set-point that does not fit; the ECU rejects it */
#define FRAME_REQUEST_NONE 7u            /* no command for this channel */

/* One classic frame on the bus. */
typedef struct {
  uint16_t id;
  uint8_t size;
  uint8_t data[8];
} bus_frame;

typedef enum {
  FRAME_EMERGENCY = 1,
  FRAME_COMMAND = 2,
  FRAME_STATUS_0 = 3,
  FRAME_STATUS_1 = 4,
  FRAME_ANALOG = 5,
  FRAME_HEALTH_0 = 6,
  FRAME_HEALTH_1 = 7,
  FRAME_PARAMETER = 8,
  FRAME_DISCOVER = 9,
  FRAME_HELLO = 10
} frame_function;

typedef enum {
  FRAME_RESET_POWER = 0,
  FRAME_RESET_BROWN_OUT = 1,
  FRAME_RESET_WATCHDOG = 2,
  FRAME_RESET_SOFTWARE = 3
} frame_reset_cause;

typedef struct {
  bool boot;           /* true: the ECU has booted; false: a channel has tripped */
  uint8_t channel;     /* of the fault */
  uint8_t fault;       /* ecu_fault */
  uint8_t reset_cause; /* frame_reset_cause of the boot */
  uint8_t version;     /* FRAME_VERSION of the ECU */
  uint32_t tick;       /* periods since boot */
} frame_emergency;

typedef struct {
  uint8_t request;  /* ecu_request or FRAME_REQUEST_NONE */
  int32_t setpoint; /* in the unit of the request, see ecu.h */
} frame_channel_command;

typedef struct {
  frame_channel_command channel[2];
  uint8_t answers; /* 0..7 */
  uint8_t count;   /* 0..7 */
} frame_command;

typedef struct {
  uint16_t encoder_low;
  int16_t current_counts;  /* -2048..2047, saturated */
  uint16_t tension_counts; /* 0..4095, saturated */
  uint8_t state;           /* ecu_state */
  int16_t duty;            /* 0 unless running */
  uint8_t fault, request;  /* request: FRAME_REQUEST_NONE while running (not sent) */
  bool warning;            /* false while running (not sent) */
  bool follows;            /* the newest command that this channel received was accepted */
  uint8_t counter;         /* 0..7 */
} frame_status;

typedef struct {
  uint8_t page;      /* inputs 2 page, 2 page + 1 */
  uint8_t present;   /* bit k: counts[k] is a reading */
  int32_t counts[2]; /* 24 bits signed, saturated */
  uint8_t counter;
} frame_analog;

typedef struct {
  uint8_t
      page; /* 0: encoder to zero_known; 1: request to accepted_gain_sets; the other fields are 0 */
  uint8_t counter;
  int32_t encoder_counts; /* full count */
  bool warning;
  uint8_t lost, corrupt; /* commands since boot, modulo 256 */
  bool zero_known;       /* the encoder count is absolute */
  uint8_t request;
  int32_t setpoint;           /* in effect */
  uint16_t rejected;          /* set-points since boot, modulo 65536 */
  uint8_t refused_gain_sets;  /* since boot, modulo 256 */
  uint8_t accepted_gain_sets; /* since boot, modulo 8 */
} frame_health;

typedef struct {
  uint8_t channel, index;
  bool commit;
  uint8_t position; /* 0 begins a set, then 1, 2 .. 255, 1 ..; a gap invalidates the set */
  float value;
} frame_parameter;

typedef struct {
  uint8_t version;       /* FRAME_VERSION of the ECU */
  uint8_t channels;      /* bit k: channel k is fitted */
  uint8_t analog_inputs; /* bit k: input k has a sensor */
  uint8_t reset_cause;   /* frame_reset_cause of its last boot */
  uint32_t serial;       /* lower 24 bits of the board's serial number; 0: none */
} frame_hello;

uint16_t frame_identifier(frame_function function, uint8_t ecu);
frame_function frame_function_of(const bus_frame* frame);
uint8_t frame_ecu_of(const bus_frame* frame);
uint8_t frame_crc8(const uint8_t* bytes, unsigned count);
/* True if size and check value are correct. */
bool frame_is_intact(const bus_frame* frame);

/* Packing sets all of `frame`. Unpacking returns false and leaves the result unchanged when the
 * frame is corrupt, has another function, or contains an invalid value. */
void frame_pack_emergency(bus_frame* frame, uint8_t ecu, const frame_emergency* content);
bool frame_unpack_emergency(const bus_frame* frame, frame_emergency* content);
void frame_pack_command(bus_frame* frame, uint8_t ecu, const frame_command* content);
bool frame_unpack_command(const bus_frame* frame, frame_command* content);
void frame_pack_status(bus_frame* frame, uint8_t ecu, uint8_t channel, const frame_status* content);
bool frame_unpack_status(const bus_frame* frame, frame_status* content);
void frame_pack_analog(bus_frame* frame, uint8_t ecu, const frame_analog* content);
bool frame_unpack_analog(const bus_frame* frame, frame_analog* content);
void frame_pack_health(bus_frame* frame, uint8_t ecu, uint8_t channel, const frame_health* content);
bool frame_unpack_health(const bus_frame* frame, frame_health* content);
void frame_pack_parameter(bus_frame* frame, uint8_t ecu, const frame_parameter* content);
bool frame_unpack_parameter(const bus_frame* frame, frame_parameter* content);
void frame_pack_discover(bus_frame* frame, uint8_t ecu);
bool frame_unpack_discover(const bus_frame* frame);
void frame_pack_hello(bus_frame* frame, uint8_t ecu, const frame_hello* content);
bool frame_unpack_hello(const bus_frame* frame, frame_hello* content);

/* Number of counts, modulo 8, by which `received` is ahead of `last`. FRAME_LATE or more:
 * `received` is older than `last`. */
#define FRAME_LATE 6u
uint8_t frame_ahead(uint8_t received, uint8_t last);

/* The full count nearest to `last` whose lower half is `low`. */
int32_t frame_unwrap(int32_t last, uint16_t low);

#ifdef __cplusplus
}
#endif
#endif
