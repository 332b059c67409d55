#include "firmware/board/cortex_m/bxcan.h"
#include "firmware/board/cortex_m/can_port.h"
#include "firmware/board/cortex_m/stm32f405.h"

static bxcan_registers* const can = (bxcan_registers*)CAN1_BASE;
static bool joined;

void can_port_open(uint8_t ecu) {
  REGISTER(RCC_APB1ENR) |= RCC_CAN1EN;
  pin_alternate(GPIOB_BASE, 8, 9); /* CAN1_RX, */
  pin_alternate(GPIOB_BASE, 9, 9); /* CAN1_TX: data sheet DS8626, table 9 */
  joined = bxcan_open(can, BXCAN_BTR_1_MBIT_42_MHZ, ecu);
}

bool can_port_is_off(void) { return !joined || bxcan_is_off(can); }
bool can_port_receive(bus_frame* frame) { return joined && bxcan_receive(can, frame); }
bool can_port_send(const bus_frame* frame) { return joined && bxcan_send(can, frame); }
