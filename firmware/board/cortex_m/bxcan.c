#include "firmware/board/cortex_m/bxcan.h"

/* Bits, by RM0090 32.9.2 to 32.9.4. */
enum {
  MCR_INRQ = 1 << 0,
  MCR_SLEEP = 1 << 1,
  MCR_AWUM = 1 << 5,
  MCR_ABOM = 1 << 6, /* automatic recovery from bus-off */
  MSR_INAK = 1 << 0,
  TSR_TME0 = 1 << 26,
  RFR_FMP = 3,
  RFR_RFOM = 1 << 5,
  ESR_BOFF = 1 << 2,
  FMR_FINIT = 1 << 0,
  TIR_TXRQ = 1 << 0,
  TIR_IDE = 1 << 2,
  TIR_RTR = 1 << 1
};
#define STID_SHIFT 21u /* of an 11-bit identifier in TIR, RIR and a filter */
#define DLC 0xFu
#define MAX_POLLS 100000u /* chosen; joining the bus takes 11 bits, 11 us at 1 Mbit/s */

/* Waits until the controller has entered (MSR_INAK) or left (0) initialization mode. */
static bool wait_for_mode(const bxcan_registers* can, uint32_t expected) {
  for (uint32_t polls = 0; polls < MAX_POLLS; ++polls)
    if ((can->MSR & MSR_INAK) == expected) return true;
  return false;
}

/* Filter bank `bank` passes every standard data frame to this address into FIFO 0. */
static void set_filter(bxcan_registers* can, unsigned bank, uint32_t address) {
  can->FM1R &= ~(1u << bank);  /* mask, not list */
  can->FS1R |= 1u << bank;     /* one of 32 bits */
  can->FFA1R &= ~(1u << bank); /* FIFO 0 */
  can->filter[bank].FR1 = address << STID_SHIFT;
  can->filter[bank].FR2 = 0x7Fu << STID_SHIFT | TIR_IDE | TIR_RTR;
  can->FA1R |= 1u << bank;
}

bool bxcan_open(bxcan_registers* can, uint32_t btr, uint8_t ecu) {
  can->MCR = MCR_INRQ;
  if (!wait_for_mode(can, MSR_INAK)) return false;
  can->MCR = MCR_INRQ | MCR_ABOM | MCR_AWUM;
  can->BTR = btr;
  can->FMR |= FMR_FINIT;
  can->FA1R = 0;
  set_filter(can, 0, ecu);
  set_filter(can, 1, FRAME_EVERYONE);
  can->FMR &= ~(uint32_t)FMR_FINIT;
  can->MCR = MCR_ABOM | MCR_AWUM;
  return wait_for_mode(can, 0);
}

static void get_bytes(bus_frame* frame, uint32_t low, uint32_t high) {
  for (unsigned i = 0; i < 4u; ++i) {
    frame->data[i] = (uint8_t)(low >> (8u * i));
    frame->data[i + 4u] = (uint8_t)(high >> (8u * i));
  }
}

static uint32_t word_of(const uint8_t* bytes) {
  return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

/* The FIFO still counts a frame while it is being released. */
static bool has_frame(const bxcan_registers* can) {
  const uint32_t fifo = can->RFR[0];
  return (fifo & RFR_FMP) != 0u && (fifo & RFR_RFOM) == 0u;
}

bool bxcan_receive(bxcan_registers* can, bus_frame* frame) {
  while (has_frame(can)) {
    const uint32_t identifier = can->fifo[0].RIR, size = can->fifo[0].RDTR & DLC;
    get_bytes(frame, can->fifo[0].RDLR, can->fifo[0].RDHR);
    can->RFR[0] = RFR_RFOM;
    if (identifier & (TIR_IDE | TIR_RTR)) continue;
    frame->id = (uint16_t)(identifier >> STID_SHIFT);
    frame->size = (uint8_t)(size > 8u ? 8u : size);
    return true;
  }
  return false;
}

bool bxcan_send(bxcan_registers* can, const bus_frame* frame) {
  for (unsigned i = 0; i < 3u; ++i) {
    if (!(can->TSR & (uint32_t)TSR_TME0 << i)) continue;
    can->mailbox[i].TDTR = frame->size;
    can->mailbox[i].TDLR = word_of(frame->data);
    can->mailbox[i].TDHR = word_of(frame->data + 4);
    can->mailbox[i].TIR = (uint32_t)frame->id << STID_SHIFT | TIR_TXRQ;
    return true;
  }
  return false;
}

bool bxcan_is_off(const bxcan_registers* can) { return can->ESR & ESR_BOFF; }
