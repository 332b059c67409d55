/* Start-up code: memory, floating point unit, vector table. */
#include "firmware/board/cortex_m/guard.h"
#include "firmware/board/cortex_m/stm32f405.h"

extern uint32_t stack_top, data_from, data_begin, data_end, bss_begin, bss_end;
int main(void);
void SysTick_Handler(void);
void USART1_Handler(void);
void USART2_Handler(void);

void Reset_Handler(void) {
  REGISTER(SCB_CPACR) |= 0xFu << 20; /* floating point unit: full access */
  __asm volatile("dsb\n isb" ::: "memory");
  const uint32_t* from = &data_from;
  for (uint32_t* to = &data_begin; to < &data_end; ++to) *to = *from++;
  for (uint32_t* to = &bss_begin; to < &bss_end; ++to) *to = 0;
  (void)main();
  guard_reset();
}

/* Any fault of the core: PWM off and reset; the boot frame reports the cause. */
static void Fault_Handler(void) { guard_reset(); }

typedef void (*handler)(void);
__attribute__((section(".vectors"), used)) static const struct {
  uint32_t* stack;
  handler core[15];
  handler peripheral[IRQ_USART2 + 1u];
} vectors = {
    &stack_top,
    {Reset_Handler, Fault_Handler, Fault_Handler, Fault_Handler, Fault_Handler, Fault_Handler, 0, 0,
     0, 0, Fault_Handler, Fault_Handler, 0, Fault_Handler, SysTick_Handler},
    {[IRQ_USART1] = USART1_Handler, [IRQ_USART2] = USART2_Handler}};
