#include "firmware/board/cortex_m/can_port.h"
#include "firmware/board/cortex_m/usart.h"
#include "firmware/board/slcan.h"

static slcan_reader reader;
static bool is_open = true; /* the host does not open the channel again after a reset */

void can_port_open(uint8_t ecu) {
  (void)ecu; /* receives all frames; ecu_link selects those for this ECU */
  usart_open(USART_HOST);
}

bool can_port_is_off(void) { return !is_open; }

bool can_port_receive(bus_frame* frame) {
  for (uint8_t byte; usart_take(USART_HOST, &byte);) {
    const slcan_event event = slcan_take(&reader, byte, frame);
    if (event == SLCAN_FRAME) return is_open;
    if (event == SLCAN_OPEN) is_open = true;
    if (event == SLCAN_CLOSE) is_open = false;
  }
  return false;
}

bool can_port_send(const bus_frame* frame) {
  char text[SLCAN_LINE_MAX];
  return is_open && usart_send(USART_HOST, (const uint8_t*)text, slcan_write(text, frame));
}
