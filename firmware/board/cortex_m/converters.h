/* Converters and PWM as this board's main loop sees them. They belong to a schematic; so far there
 * is one: those of a simulated robot, over the serial line USART_ROBOT (firmware/board/wire.h). */
#ifndef ERP_FIRMWARE_CONVERTERS_H
#define ERP_FIRMWARE_CONVERTERS_H
#include "firmware/board/wire.h"

void converters_open(uint8_t ecu);

/* Has all converters read once; `turn` as of the readings at hand (board.h). */
void converters_start(uint8_t turn);

/* Returns true when that is done, and fills `readings`. */
bool converters_done(board_readings* readings);

/* What a test has done to this program since the last call; kind 0: nothing. */
wire_mishap converters_mishap(void);

void pwm_set(const int16_t* duty);
#endif
