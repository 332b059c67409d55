/* What an ECU has still to say, when its controller takes frames more slowly than they come:
 * an EMERGENCY waits until it is out; of all else only the newest period is worth saying. */
#ifndef ERP_FIRMWARE_OUTBOX_H
#define ERP_FIRMWARE_OUTBOX_H
#include "firmware/core/link.h"

#ifdef __cplusplus
extern "C" {
#endif

#define OUTBOX_EMERGENCIES_MAX 4u
#define OUTBOX_FRAMES_MAX (OUTBOX_EMERGENCIES_MAX + ECU_LINK_FRAMES_MAX)

/* Zero it first. */
typedef struct {
  bus_frame frames[OUTBOX_FRAMES_MAX];
  uint8_t count;
  uint32_t dropped; /* frames that gave way, since boot */
} ecu_outbox;

/* Adds what a period has to say, most urgent first, at most ECU_LINK_FRAMES_MAX. What is left of
 * earlier periods gives way, but for the oldest OUTBOX_EMERGENCIES_MAX emergencies. */
void outbox_put(ecu_outbox* outbox, const bus_frame* frames, unsigned count);

/* The next frame to send, or null; and that it has been taken. */
const bus_frame* outbox_next(const ecu_outbox* outbox);
void outbox_sent(ecu_outbox* outbox);

#ifdef __cplusplus
}
#endif
#endif
