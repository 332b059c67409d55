#include "firmware/board/cortex_m/guard.h"

#include "firmware/board/cortex_m/converters.h"
#include "firmware/board/cortex_m/stm32f405.h"
#include "firmware/board/cortex_m/usart.h"

enum { CSR_BOR = 1 << 25, CSR_POR = 1 << 27, CSR_SFT = 1 << 28, CSR_IWDG = 1 << 29 };
#define CSR_CLEAR_FLAGS (1u << 24)
#define WATCHDOG_MARKER 0x0B17E4EDu /* chosen: unlikely as random RAM content */

static volatile uint32_t now_ms, kicked_ms;
/* Keeps its value over a reset, because start-up code does not change it. */
static volatile uint32_t reset_marker __attribute__((section(".noinit")));

void guard_start(void) {
  REGISTER(IWDG_KR) = IWDG_KEY_WRITE;
  REGISTER(IWDG_PR) = 0;
  REGISTER(IWDG_RLR) = GUARD_TIMEOUT_MS * 8u; /* ticks of the 8 kHz watchdog clock */
  REGISTER(IWDG_KR) = IWDG_KEY_START;
  REGISTER(SYST_RVR) = CORE_HZ / 1000u - 1u;
  REGISTER(SYST_CVR) = 0;
  REGISTER(SYST_CSR) = 7; /* core clock, interrupt, on */
}

void guard_kick(void) {
  kicked_ms = now_ms;
  REGISTER(IWDG_KR) = IWDG_KEY_KICK;
}

uint32_t guard_ms(void) { return now_ms; }

void guard_reset(void) {
  static const int16_t off[2];
  pwm_set(off);
  usart_pump();
  reset_marker = WATCHDOG_MARKER;
  REGISTER(SCB_AIRCR) = SCB_AIRCR_RESET;
  for (;;) continue;
}

void SysTick_Handler(void) {
  ++now_ms;
  if (now_ms - kicked_ms > GUARD_TIMEOUT_MS) guard_reset();
}

frame_reset_cause guard_reset_cause(void) {
  const uint32_t flags = REGISTER(RCC_CSR);
  const bool by_watchdog = reset_marker == WATCHDOG_MARKER;
  reset_marker = 0;
  REGISTER(RCC_CSR) = flags | CSR_CLEAR_FLAGS;
  if (flags & CSR_IWDG || by_watchdog) return FRAME_RESET_WATCHDOG;
  if (flags & CSR_SFT) return FRAME_RESET_SOFTWARE;
  if (flags & CSR_BOR && !(flags & CSR_POR)) return FRAME_RESET_BROWN_OUT;
  return FRAME_RESET_POWER;
}
