/* The main loop of an ECU, independent of the board. Its inputs are converter readings; its outputs
 * are PWM duties and frames. A board adds converters, PWM, a CAN controller, a 2 ms timer and a
 * watchdog:
 *
 *   at reset:         ecu_board_init(&board, &fitted, cause, &frame); send frame
 *   on a frame:       ecu_board_receive(&board, &frame)
 *   every 2 ms:       count = ecu_board_period(&board, &period, duty, frames); send them; kick
 *   watchdog, 10 ms:  PWM off by hardware, reset
 *
 * A simulated robot may run in lockstep: it waits for its ECUs, and they wait for their host. Then
 * the next period runs only after the host has answered the previous one and new readings exist:
 *
 *   every 2 ms:       if ecu_board_awaits_host: occasionally ecu_board_repeat; kick
 *                     else read converters; if not ecu_board_awaits_robot: a period as above
 */
#ifndef ERP_FIRMWARE_BOARD_H
#define ERP_FIRMWARE_BOARD_H
#include "firmware/core/link.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The equipment of the board. */
typedef struct {
  uint8_t ecu;           /* address, 0 .. 126 */
  uint8_t channels;      /* bit k: channel k drives a motor */
  uint8_t analog_inputs; /* bit k: input k has a sensor */
  uint32_t serial;       /* 24 bits */
} board_fitted;

/* One reading of all converters. */
typedef struct {
  ecu_inputs channel[2]; /* potentiometer_counts are taken from `analog` instead */
  int32_t analog[ECU_ANALOG_INPUTS];
  uint8_t turn; /* lockstep: number of the reading, 1 .. 255; 0: no lockstep */
} board_readings;

typedef struct {
  board_readings readings;
  bool overran; /* the computation of the last period had not ended when this one began */
  bool bus_off; /* the CAN controller is in bus-off */
} board_period;

typedef struct {
  ecu_channel channel[2];
  ecu_link link;
  ecu_report report; /* of the current period */
  uint8_t turn;      /* of the readings that the report was computed from */
} ecu_board;

/* Both channels in boot, PWM 0. `boot` is the frame to send first. */
void ecu_board_init(ecu_board* board, const board_fitted* fitted, frame_reset_cause cause,
                    bus_frame* boot);

void ecu_board_receive(ecu_board* board, const bus_frame* frame);

/* One control period. Sets both duties (0 for a channel that is not fitted) and at most
 * ECU_LINK_FRAMES_MAX frames; returns how many. */
unsigned ecu_board_period(ecu_board* board, const board_period* period, int16_t* duty,
                          bus_frame* frames);

/* In lockstep: true while the host has not answered the last period; true while there are no new
 * readings. */
bool ecu_board_awaits_host(const ecu_board* board, const board_readings* last_readings);
bool ecu_board_awaits_robot(const ecu_board* board, const board_readings* last_readings);

/* Packs all frames of the last period again, for the case that its answer was lost. Returns the
 * number of frames. */
unsigned ecu_board_repeat(ecu_board* board, bus_frame* frames);
#define ECU_BOARD_REPEAT_PERIODS 50u  /* 100 ms of waiting for the host; chosen */
#define ECU_BOARD_REQUEST_PERIODS 10u /* 20 ms of waiting for the robot; chosen */

#ifdef __cplusplus
}
#endif
#endif
