/* Converters and PWM as used by this board's main loop. They depend on a schematic; the only
 * implementation so far is a simulated robot's, over the serial line USART_ROBOT
 * (firmware/board/wire.h). */
#ifndef ERP_FIRMWARE_CONVERTERS_H
#define ERP_FIRMWARE_CONVERTERS_H
#include "firmware/board/wire.h"

void converters_open(uint8_t ecu);

/* Starts one reading of all converters; `turn`: number of the last readings (board.h). */
void converters_start(uint8_t turn);

/* Returns true when the reading is complete, and fills `readings`. */
bool converters_done(board_readings* readings);

/* The fault that a test has injected since the last call; kind 0: none. */
wire_fault converters_fault(void);

void pwm_set(const int16_t* duty);
#endif
