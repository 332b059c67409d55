/* One ECU on the bus: frames heard drive its two channels, and after each period it says what it
 * measured. Used by the microcontroller's main loop and by the virtual ECUs of the simulator.
 *
 *   on a frame:   ecu_link_hear(&link, &frame)
 *   every 2 ms:   duty = ecu_tick(...) for each channel
 *                 ecu_link_tick(&link)
 *                 count = ecu_link_say(&link, &said, false, frames)
 */
#ifndef ERP_FIRMWARE_LINK_H
#define ERP_FIRMWARE_LINK_H
#include "firmware/core/frame.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ECU_CORRUPT_TRIP 5u    /* corrupt frames in a row: ECU_FAULT_CORRUPT */
#define ECU_HEALTH_TICKS 25u   /* one HEALTH frame every 50 ms; a round takes 200 ms */
#define ECU_LINK_FRAMES_MAX 11 /* 2 EMERGENCY, HELLO, 4 HEALTH, 2 ANALOG, 2 STATUS */
#define ECU_ANALOG_INPUTS 4

typedef struct {
  uint8_t ecu;             /* address, 0..127 */
  uint8_t analog_inputs;   /* bit k: input k has a sensor */
  ecu_channel* channel[2]; /* lent; null where none is fitted */
  uint32_t tick;           /* periods since boot */
  uint32_t serial;         /* of the board, 24 bits; its owner sets it */
  uint8_t reset_cause;     /* frame_reset_cause */
  /* heard */
  bool has_heard;
  bool answered;      /* a command computed from this tick's STATUS has come */
  uint8_t last_count; /* of a COMMAND */
  bool follows[2];
  bool set_open[2]; /* PARAMETERs were heard since the last commit */
  uint8_t last_position[2];
  uint32_t corrupt_in_a_row;
  uint32_t lost, late, repeated, corrupt; /* since boot */
  /* said */
  bool asked_for_hello;
  bool said_fault[2];
  uint8_t health_turn;
} ecu_link;

/* What one period gives to say. */
typedef struct {
  ecu_state state;
  ecu_fault fault;
  ecu_request request;
  int32_t setpoint;
  ecu_inputs inputs;
  int16_t duty;
} ecu_reading;
typedef struct {
  ecu_reading channel[2];
  int32_t analog_counts[ECU_ANALOG_INPUTS];
} ecu_report;

void ecu_link_init(ecu_link* link, uint8_t ecu, ecu_channel* channel_0, ecu_channel* channel_1,
                   uint8_t analog_inputs);

/* Takes one frame off the bus. Returns true when it was for this ECU and was used; a repeated or
 * late command, a corrupt frame or another's frame changes no channel (but see ECU_CORRUPT_TRIP).
 */
bool ecu_link_hear(ecu_link* link, const bus_frame* frame);

/* Begins a period: counts up, nothing answered yet. */
void ecu_link_tick(ecu_link* link);

/* A channel as its last tick left it. */
ecu_reading ecu_reading_of(const ecu_channel* channel);

/* The frames of this period, STATUS last, at most ECU_LINK_FRAMES_MAX. `whole` adds HELLO and every
 * HEALTH page: for the first period, to say a period again, and whenever a host has asked. */
unsigned ecu_link_say(ecu_link* link, const ecu_report* report, bool whole, bus_frame* frames);

/* The one frame to say after a reset. */
void ecu_link_say_boot(ecu_link* link, frame_reset_cause cause, bus_frame* frame);

/* Tells, once a period, whether the CAN controller is off the bus: then both channels trip. */
void ecu_link_bus(ecu_link* link, bool off);

#ifdef __cplusplus
}
#endif
#endif
