/* An ECU on an STM32F405. Each period: converters, control, PWM, frames, watchdog kick. */
#include "firmware/board/cortex_m/can_port.h"
#include "firmware/board/cortex_m/converters.h"
#include "firmware/board/cortex_m/guard.h"
#include "firmware/board/cortex_m/identity.h"
#include "firmware/board/cortex_m/usart.h"
#include "firmware/board/outbox.h"

#define PERIOD_MS 2u
#define CONVERSION_MS 1u /* chosen; after this time the last readings are used again */

static ecu_board board;
static board_period period;
static ecu_outbox outbox;
static wire_fault active_fault; /* injected by a test, with a duration */

static bool has_fault(wire_fault_kind kind) { return active_fault.kind == (uint8_t)kind; }
static bool is_off(void) { return can_port_is_off() || has_fault(WIRE_FAULT_BUS_OFF); }

static bool send_next(void) {
  const bus_frame* next = outbox_next(&outbox);
  if (next == 0 || is_off() || !can_port_send(next)) return false;
  outbox_sent(&outbox);
  return true;
}

/* Receives and sends frames; to be called continuously. */
static void serve(void) {
  bus_frame frame;
  while (can_port_receive(&frame))
    if (!is_off()) ecu_board_receive(&board, &frame);
  while (send_next()) continue;
  usart_pump();
}

static void rest_until(uint32_t ms) {
  while ((int32_t)(guard_ms() - ms) < 0) {
    serve();
    usart_rest();
  }
}

/* Reads the converters, unless the answer to the previous request has arrived and can be used, as
 * in lockstep. Returns false when no answer arrives in time. Waits without sleeping, because a
 * conversion takes microseconds, and sleep and wake-up take longer in an emulator. */
static bool convert(bool request) {
  const uint32_t start_ms = guard_ms();
  const bool has_previous = converters_done(&period.readings);
  if (!request || (has_previous && period.readings.turn != board.turn)) return has_previous;
  converters_start(period.readings.turn);
  usart_pump();
  while (!converters_done(&period.readings))
    if (guard_ms() - start_ms > CONVERSION_MS) return has_previous;
  return true;
}

static void apply_fault(void) {
  const wire_fault injected = converters_fault();
  if (injected.kind == WIRE_FAULT_HANG)
    for (;;) continue;
  if (injected.kind != 0) active_fault = injected;
  if (active_fault.periods == 0) active_fault.kind = 0;
  else --active_fault.periods;
}

static void repeat_if_due(unsigned wait_periods) {
  bus_frame frames[ECU_LINK_FRAMES_MAX];
  if (wait_periods % ECU_BOARD_REPEAT_PERIODS == 0u)
    outbox_put(&outbox, frames, ecu_board_repeat(&board, frames));
}

/* Reads the converters. Returns false while the next period must wait in lockstep. */
static bool may_run(void) {
  static unsigned host_wait_periods, robot_wait_periods;
  if (ecu_board_awaits_host(&board, &period.readings)) {
    repeat_if_due(++host_wait_periods);
    return false;
  }
  host_wait_periods = 0;
  (void)convert(robot_wait_periods++ % ECU_BOARD_REQUEST_PERIODS == 0u);
  if (ecu_board_awaits_robot(&board, &period.readings)) return false;
  robot_wait_periods = 0;
  return true;
}

static void run_period(uint32_t start_ms) {
  bus_frame frames[ECU_LINK_FRAMES_MAX];
  int16_t duty[2];
  apply_fault();
  period.bus_off = is_off();
  const unsigned count = ecu_board_period(&board, &period, duty, frames);
  pwm_set(duty);
  outbox_put(&outbox, frames, count);
  while (has_fault(WIRE_FAULT_BUSY) && guard_ms() - start_ms < PERIOD_MS) continue;
  period.overran = guard_ms() - start_ms >= PERIOD_MS;
}

/* The ECU starts when the simulated robot answers. */
static void wait_for_robot(void) {
  while (!convert(true)) {
    const uint32_t requested_ms = guard_ms();
    while (guard_ms() - requested_ms < ECU_BOARD_REQUEST_PERIODS * PERIOD_MS) {
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
  wait_for_robot();
  outbox_put(&outbox, &boot, 1);
  for (uint32_t due_ms = guard_ms();; due_ms += PERIOD_MS) {
    rest_until(due_ms);
    if (may_run()) run_period(due_ms);
    guard_kick();
    if (guard_ms() - due_ms >= 2u * PERIOD_MS)
      due_ms = guard_ms(); /* do not catch up missed periods */
  }
}
