/* The bus as used by this board's main loop. Two implementations, chosen at link time:
 *
 *   can_port_bxcan.c  the CAN controller of the microcontroller (STM32F4)
 *   can_port_slcan.c  frames as text on a serial line, for a host whose kernel has slcan; the only
 *                     one that an emulator can run
 */
#ifndef ERP_FIRMWARE_CAN_PORT_H
#define ERP_FIRMWARE_CAN_PORT_H
#include "firmware/core/frame.h"

/* Joins the bus as ECU `ecu`. */
void can_port_open(uint8_t ecu);

/* True in bus-off, or while the channel is not open. */
bool can_port_is_off(void);

bool can_port_receive(bus_frame* frame);

/* Returns false while there is no room; the caller then repeats the call. */
bool can_port_send(const bus_frame* frame);
#endif
