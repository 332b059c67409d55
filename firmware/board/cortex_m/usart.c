#include "firmware/board/cortex_m/usart.h"

#include "firmware/board/cortex_m/stm32f405.h"

#define RING 1024u /* bytes, a power of two */
#define SR_RXNE (1u << 5)
#define SR_TXE (1u << 7)
#define CR1_ON (1u << 13 | 1u << 5 | 1u << 3 | 1u << 2) /* UE, RXNEIE, TE, RE */
#define BAUD 1000000u

/* The producer writes only `in`, the consumer only `out`, so interrupt and main loop need no
 * lock. */
typedef struct {
  volatile uint8_t bytes[RING];
  volatile uint32_t in, out;
} ring;

static uint32_t waiting(const ring* r) { return r->in - r->out; }

static void push(ring* r, uint8_t byte) {
  r->bytes[r->in % RING] = byte;
  ++r->in;
}

static uint8_t pop(ring* r) {
  const uint8_t byte = r->bytes[r->out % RING];
  ++r->out;
  return byte;
}

typedef struct {
  volatile uint32_t SR, DR, BRR, CR1;
} registers;
static registers* const usart[2] = {(registers*)0x40011000u, (registers*)0x40004400u};
static ring rx[2], tx[2];

void usart_open(usart_line line) {
  const bool host = line == USART_HOST;
  const unsigned tx_pin = host ? 9 : 2;
  if (host) REGISTER(RCC_APB2ENR) |= RCC_USART1EN;
  else REGISTER(RCC_APB1ENR) |= RCC_USART2EN;
  pin_alternate(GPIOA_BASE, tx_pin, 7);
  pin_alternate(GPIOA_BASE, tx_pin + 1u, 7);
  usart[line]->BRR = (host ? APB2_HZ : APB1_HZ) / BAUD;
  usart[line]->CR1 = CR1_ON;
  REGISTER(NVIC_ISER1) = 1u << ((host ? IRQ_USART1 : IRQ_USART2) - 32u);
}

static void receive(usart_line line) {
  while (usart[line]->SR & SR_RXNE) {
    const uint8_t byte = (uint8_t)usart[line]->DR;
    if (waiting(&rx[line]) < RING - 1u) push(&rx[line], byte);
  }
}
void USART1_Handler(void) { receive(USART_HOST); }
void USART2_Handler(void) { receive(USART_ROBOT); }

bool usart_take(usart_line line, uint8_t* byte) {
  if (waiting(&rx[line]) == 0) return false;
  *byte = pop(&rx[line]);
  return true;
}

void usart_rest(void) {
  __asm volatile(
      "cpsid i" ::
          : "memory"); /* with interrupts off, a byte that arrives now still wakes the core */
  if (waiting(&rx[0]) == 0 && waiting(&rx[1]) == 0) __asm volatile("wfi");
  __asm volatile("cpsie i" ::: "memory");
}

bool usart_send(usart_line line, const uint8_t* bytes, unsigned count) {
  if (waiting(&tx[line]) + count >= RING) return false;
  for (unsigned i = 0; i < count; ++i) push(&tx[line], bytes[i]);
  return true;
}

void usart_pump(void) {
  for (unsigned line = 0; line < 2; ++line)
    while (waiting(&tx[line]) > 0 && (usart[line]->SR & SR_TXE)) usart[line]->DR = pop(&tx[line]);
}
