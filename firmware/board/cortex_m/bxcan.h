/* The CAN controller of STM32F4 (bxCAN), polled. Source: ST RM0090 rev 19, section 32.
 *
 * Not yet run on silicon: its register accesses are tested on memory that replaces the registers.
 */
#ifndef ERP_FIRMWARE_BXCAN_H
#define ERP_FIRMWARE_BXCAN_H
#include "firmware/core/frame.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef volatile uint32_t bxcan_register;

/* RM0090 32.9.5: the register map. */
typedef struct {
  bxcan_register MCR, MSR, TSR, RFR[2], IER, ESR, BTR;
  bxcan_register reserved_0[88];
  struct {
    bxcan_register TIR, TDTR, TDLR, TDHR;
  } mailbox[3];
  struct {
    bxcan_register RIR, RDTR, RDLR, RDHR;
  } fifo[2];
  bxcan_register reserved_1[12];
  bxcan_register FMR, FM1R, reserved_2, FS1R, reserved_3, FFA1R, reserved_4, FA1R;
  bxcan_register reserved_5[8];
  struct {
    bxcan_register FR1, FR2;
  } filter[28];
} bxcan_registers;

/* 1 Mbit/s from a 42 MHz clock, prescaled by 3: 14 quanta per bit, 1 + 10 + 3, sampled at 79 %.
 * BTR = SJW 0, TS2 - 1 = 2, TS1 - 1 = 9, prescaler - 1 = 2. */
#define BXCAN_BTR_1_MBIT_42_MHZ (2u << 20 | 9u << 16 | 2u)

/* Leaves reset and joins the bus; receives frames for `ecu` and for all ECUs. Returns false when
 * the controller does not change its mode within 100 000 polls; then it stays off the bus. Clock
 * and pins of the controller must be enabled. */
bool bxcan_open(bxcan_registers* can, uint32_t btr, uint8_t ecu);

/* Takes a received frame. Ignores extended and remote frames, which no ECU uses. */
bool bxcan_receive(bxcan_registers* can, bus_frame* frame);

/* Writes a frame into a mailbox. Returns false while no mailbox is free. The mailbox with the
 * lowest identifier is sent first. */
bool bxcan_send(bxcan_registers* can, const bus_frame* frame);

/* True if the controller is in bus-off. It recovers by itself after 128 times 11 recessive bits,
 * 1.4 ms of an idle bus at 1 Mbit/s. */
bool bxcan_is_off(const bxcan_registers* can);

#ifdef __cplusplus
}
#endif
#endif
