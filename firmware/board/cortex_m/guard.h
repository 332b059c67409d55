/* Time, and the two watchdogs over the main loop.
 *
 * The timer interrupt checks that the loop has kicked within 10 ms; if not, it switches PWM off and
 * resets the core. The independent watchdog has its own clock and resets 10 ms after the last kick
 * even if interrupts no longer run; the reset releases the PWM pins. */
#ifndef ERP_FIRMWARE_GUARD_H
#define ERP_FIRMWARE_GUARD_H
#include "firmware/core/frame.h"

#define GUARD_TIMEOUT_MS 10u

/* Starts both watchdogs and the clock. From then on the main loop must kick. */
void guard_start(void);
void guard_kick(void);

/* Milliseconds since guard_start. */
uint32_t guard_ms(void);

/* The cause of the last reset, from RCC_CSR (RM0090 7.3.21) and the marker that the guard
 * leaves. */
frame_reset_cause guard_reset_cause(void);

/* Resets at once, as after a fault of the core. */
void guard_reset(void);
#endif
