/* The registers and bits of the STM32F405 that are in use. Source: ST RM0090 rev 19; DS8626 for
 * pins. Clocks as in QEMU's netduinoplus2: core 168 MHz, APB2 84 MHz, APB1 42 MHz. */
#ifndef ERP_FIRMWARE_STM32F405_H
#define ERP_FIRMWARE_STM32F405_H
#include <stdint.h>

#define REGISTER(address) (*(volatile uint32_t*)(address))

#define CORE_HZ 168000000u
#define APB2_HZ 84000000u
#define APB1_HZ 42000000u

/* Reset and clock control, 7.3 */
#define RCC_AHB1ENR 0x40023830u
#define RCC_APB1ENR 0x40023840u
#define RCC_APB2ENR 0x40023844u
#define RCC_CSR 0x40023874u
#define RCC_USART2EN (1u << 17) /* APB1 */
#define RCC_CAN1EN (1u << 25)   /* APB1 */
#define RCC_USART1EN (1u << 4)  /* APB2 */

#define GPIOA_BASE 0x40020000u
#define GPIOB_BASE 0x40020400u
#define CAN1_BASE 0x40006400u

/* Independent watchdog, 21.4: 32 kHz, prescaled by 4 */
#define IWDG_KR 0x40003000u
#define IWDG_PR 0x40003004u
#define IWDG_RLR 0x40003008u
#define IWDG_KEY_START 0xCCCCu
#define IWDG_KEY_WRITE 0x5555u
#define IWDG_KEY_KICK 0xAAAAu

/* Cortex-M4: SysTick, interrupt controller, system control (ARM DDI 0403, B3) */
#define SYST_CSR 0xE000E010u
#define SYST_RVR 0xE000E014u
#define SYST_CVR 0xE000E018u
#define NVIC_ISER1 0xE000E104u
#define SCB_AIRCR 0xE000ED0Cu
#define SCB_AIRCR_RESET 0x05FA0004u
#define SCB_CPACR 0xE000ED88u
#define IRQ_USART1 37u
#define IRQ_USART2 38u

/* Assigns pin `pin` of the port at `gpio` to alternate function `function` (8.4); enables the
 * port's clock. */
static inline void pin_alternate(uint32_t gpio, unsigned pin, unsigned function) {
  REGISTER(RCC_AHB1ENR) |= 1u << ((gpio - GPIOA_BASE) / 0x400u);
  const uint32_t afr = gpio + 0x20u + 4u * (pin / 8u), shift = 4u * (pin % 8u);
  REGISTER(afr) = (REGISTER(afr) & ~(0xFu << shift)) | function << shift;
  REGISTER(gpio) = (REGISTER(gpio) & ~(3u << (2u * pin))) | 2u << (2u * pin);
}
#endif
