/* The main loop of an ECU, without what is particular to a board: what was read goes in, duties and
 * frames come out. A board adds converters, PWM, a CAN controller, a 2 ms timer and a watchdog:
 *
 *   at reset:         ecu_board_init(&board, &fitted, cause, &frame); send frame
 *   on a frame:       ecu_board_hear(&board, &frame)
 *   every 2 ms:       count = ecu_board_period(&board, &period, duty, frames); send them; kick
 *   watchdog, 10 ms:  PWM off by hardware, reset
 */
#ifndef ERP_FIRMWARE_BOARD_H
#define ERP_FIRMWARE_BOARD_H
#include "firmware/core/link.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is soldered on. */
typedef struct {
  uint8_t ecu;           /* address, 0 .. 126 */
  uint8_t channels;      /* bit k: channel k drives a motor */
  uint8_t analog_inputs; /* bit k: input k has a sensor */
  uint32_t serial;       /* 24 bits */
} board_fitted;

/* All converters, once. */
typedef struct {
  ecu_inputs channel[2]; /* potentiometer_counts are taken from `analog` instead */
  int32_t analog[ECU_ANALOG_INPUTS];
} board_readings;

typedef struct {
  board_readings readings;
  bool overran; /* the last period's work was not done when this one began */
  bool bus_off; /* the CAN controller has left the bus */
} board_period;

typedef struct {
  ecu_channel channel[2];
  ecu_link link;
  ecu_report report; /* of the period at hand */
} ecu_board;

/* Both channels in boot, PWM 0. `boot` is the frame to send first. */
void ecu_board_init(ecu_board* board, const board_fitted* fitted, frame_reset_cause cause,
                    bus_frame* boot);

void ecu_board_hear(ecu_board* board, const bus_frame* frame);

/* One control period. Fills both duties, 0 for a channel that is not fitted, and at most
 * ECU_LINK_FRAMES_MAX frames; returns how many. */
unsigned ecu_board_period(ecu_board* board, const board_period* period, int16_t* duty,
                          bus_frame* frames);

#ifdef __cplusplus
}
#endif
#endif
