/* One ECU on the bus. Received frames command its two channels; after each period it sends its
 * measurements. Used by the microcontroller's main loop and by the virtual ECUs of the simulator.
 *
 *   on a frame:   ecu_link_receive(&link, &frame)
 *   every 2 ms:   duty = ecu_tick(...) for each channel
 *                 ecu_link_tick(&link)
 *                 count = ecu_link_pack(&link, &report, false, frames)
 */
#ifndef ERP_FIRMWARE_LINK_H
#define ERP_FIRMWARE_LINK_H
#include "firmware/core/frame.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ECU_CORRUPT_TRIP 5u    /* consecutive corrupt frames: ECU_FAULT_CORRUPT */
#define ECU_HEALTH_TICKS 25u   /* one HEALTH frame every 50 ms; a rotation takes 200 ms */
#define ECU_LINK_FRAMES_MAX 11 /* 2 EMERGENCY, HELLO, 4 HEALTH, 2 ANALOG, 2 STATUS */
#define ECU_ANALOG_INPUTS 4

typedef struct {
  uint8_t ecu;             /* address, 0..127 */
  uint8_t analog_inputs;   /* bit k: input k has a sensor */
  ecu_channel* channel[2]; /* not owned; null where none is fitted */
  uint32_t tick;           /* periods since boot */
  uint32_t serial;         /* of the board, 24 bits; set by the owner */
  uint8_t reset_cause;     /* frame_reset_cause */
  /* received */
  bool has_received;
  bool answered;      /* a command computed from this tick's STATUS has arrived */
  uint8_t last_count; /* of a COMMAND */
  bool follows[2];
  bool set_open[2]; /* PARAMETERs were received since the last commit */
  uint8_t last_position[2];
  uint32_t consecutive_corrupt;
  uint32_t lost, late, repeated, corrupt; /* since boot */
  /* sent */
  bool hello_requested;
  bool reported_fault[2];
  uint8_t next_health_page;
} ecu_link;

/* The data of one period to be sent. */
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

/* Processes one frame from the bus. Returns true when it was for this ECU and was used. A repeated
 * or outdated command, a corrupt frame or a frame for another ECU changes no channel (exception:
 * ECU_CORRUPT_TRIP). */
bool ecu_link_receive(ecu_link* link, const bus_frame* frame);

/* Begins a period: increments the counter and resets `answered`. */
void ecu_link_tick(ecu_link* link);

/* The state of a channel after its last tick. */
ecu_reading ecu_reading_of(const ecu_channel* channel);

/* Packs the frames of this period, STATUS last, at most ECU_LINK_FRAMES_MAX. `all_pages` adds HELLO
 * and all HEALTH pages: for the first period, to repeat a period, and after a DISCOVER. */
unsigned ecu_link_pack(ecu_link* link, const ecu_report* report, bool all_pages, bus_frame* frames);

/* Packs the frame to send after a reset. */
void ecu_link_pack_boot(ecu_link* link, frame_reset_cause cause, bus_frame* frame);

/* To be called once per period. `bus_off`: the CAN controller is in bus-off; both channels then
 * trip. */
void ecu_link_bus(ecu_link* link, bool bus_off);

#ifdef __cplusplus
}
#endif
#endif
