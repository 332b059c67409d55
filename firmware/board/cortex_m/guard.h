/* Time, and the watchdogs over the main loop.
 *
 * Two of them. The timer's interrupt looks whether the loop has kicked within 10 ms; if not, PWM
 * goes off and the core resets. The independent watchdog, on a clock of its own, resets 10 ms after
 * the last kick even when interrupts are dead; its reset lets the PWM pins fall. */
#ifndef ERP_FIRMWARE_GUARD_H
#define ERP_FIRMWARE_GUARD_H
#include "firmware/core/frame.h"

#define GUARD_PATIENCE_MS 10u

/* Starts both, and the clock. From here on kick. */
void guard_start(void);
void guard_kick(void);

/* Milliseconds since guard_start. */
uint32_t guard_ms(void);

/* Why the core was reset, by RCC_CSR (RM0090 7.3.21) and by what the guard left behind. */
frame_reset_cause guard_reset_cause(void);

/* Resets at once, as from a fault of the core. */
void guard_reset(void);
#endif
