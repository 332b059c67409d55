/* An ECU on an STM32F405. Each period: converters, control, PWM, frames, a kick to the guard. */
#include "firmware/board/cortex_m/can_port.h"
#include "firmware/board/cortex_m/converters.h"
#include "firmware/board/cortex_m/guard.h"
#include "firmware/board/cortex_m/identity.h"
#include "firmware/board/cortex_m/usart.h"
#include "firmware/board/outbox.h"

#define PERIOD_MS 2u
#define CONVERSION_MS 1u /* after that the last readings serve again */

static ecu_board board;
static board_period period;
static ecu_outbox outbox;
static wire_mishap mishap; /* that lasts */

static bool suffers(wire_mishap_kind kind) { return mishap.kind == (uint8_t)kind; }
static bool is_off(void) { return can_port_is_off() || suffers(WIRE_MISHAP_BUS_OFF); }

static bool say_next(void) {
  const bus_frame* next = outbox_next(&outbox);
  if (next == 0 || is_off() || !can_port_send(next)) return false;
  outbox_sent(&outbox);
  return true;
}

/* Everything that does not wait for a period. */
static void serve(void) {
  bus_frame frame;
  while (can_port_receive(&frame))
    if (!is_off()) ecu_board_hear(&board, &frame);
  while (say_next()) continue;
  usart_pump();
}

static void rest_until(uint32_t ms) {
  while ((int32_t)(guard_ms() - ms) < 0) {
    serve();
    usart_rest();
  }
}

/* Has the converters read, unless an answer to the question before is as good: in lockstep none is
 * too late. Returns false when none comes in time. Waits awake: a conversion takes microseconds,
 * and to fall asleep and wake costs an emulator more than that. */
static bool convert(bool ask) {
  const uint32_t began_ms = guard_ms();
  const bool late = converters_done(&period.readings);
  if (!ask || (late && period.readings.turn != board.turn)) return late;
  converters_start(period.readings.turn);
  usart_pump();
  while (!converters_done(&period.readings))
    if (guard_ms() - began_ms > CONVERSION_MS) return late;
  return true;
}

static void suffer(void) {
  const wire_mishap befell = converters_mishap();
  if (befell.kind == WIRE_MISHAP_HANG)
    for (;;) continue;
  if (befell.kind != 0) mishap = befell;
  if (mishap.periods == 0) mishap.kind = 0;
  else --mishap.periods;
}

static void repeat_now_and_then(unsigned waited) {
  bus_frame frames[ECU_LINK_FRAMES_MAX];
  if (waited % ECU_BOARD_REPEAT_PERIODS == 0u)
    outbox_put(&outbox, frames, ecu_board_repeat(&board, frames));
}

/* Has the converters read. Returns false while, in lockstep, a period has to wait. */
static bool may_pass(void) {
  static unsigned for_host, for_robot;
  if (ecu_board_awaits_host(&board, &period.readings)) {
    repeat_now_and_then(++for_host);
    return false;
  }
  for_host = 0;
  (void)convert(for_robot++ % ECU_BOARD_ASK_PERIODS == 0u);
  if (ecu_board_awaits_robot(&board, &period.readings)) return false;
  for_robot = 0;
  return true;
}

static void pass_period(uint32_t began_ms) {
  bus_frame frames[ECU_LINK_FRAMES_MAX];
  int16_t duty[2];
  suffer();
  period.bus_off = is_off();
  const unsigned count = ecu_board_period(&board, &period, duty, frames);
  pwm_set(duty);
  outbox_put(&outbox, frames, count);
  while (suffers(WIRE_MISHAP_BUSY) && guard_ms() - began_ms < PERIOD_MS) continue;
  period.overran = guard_ms() - began_ms >= PERIOD_MS;
}

/* Without a robot there is nothing to run on. */
static void wait_for_power(void) {
  while (!convert(true)) {
    const uint32_t asked_ms = guard_ms();
    while (guard_ms() - asked_ms < ECU_BOARD_ASK_PERIODS * PERIOD_MS) {
      guard_kick();
      rest_until(guard_ms() + 1u);
    }
  }
}

int main(void) {
  board_fitted fitted;
  if (!identity_read(&fitted))
    for (;;) __asm volatile("wfi");
  guard_start();
  can_port_open(fitted.ecu);
  converters_open(fitted.ecu);
  bus_frame boot;
  ecu_board_init(&board, &fitted, guard_reset_cause(), &boot);
  wait_for_power();
  outbox_put(&outbox, &boot, 1);
  for (uint32_t due_ms = guard_ms();; due_ms += PERIOD_MS) {
    rest_until(due_ms);
    if (may_pass()) pass_period(due_ms);
    guard_kick();
    if (guard_ms() - due_ms >= 2u * PERIOD_MS) due_ms = guard_ms(); /* what is missed is missed */
  }
}
