/* Transmit queue of an ECU, for a bus that is slower than the ECU: an EMERGENCY is kept until it is
 * sent; all other frames are kept only from the newest period. */
#ifndef ERP_FIRMWARE_OUTBOX_H
#define ERP_FIRMWARE_OUTBOX_H
#include "firmware/core/link.h"

#ifdef __cplusplus
extern "C" {
#endif

#define OUTBOX_EMERGENCIES_MAX 4u
#define OUTBOX_FRAMES_MAX (OUTBOX_EMERGENCIES_MAX + ECU_LINK_FRAMES_MAX)

/* Initialize to zero. */
typedef struct {
  bus_frame frames[OUTBOX_FRAMES_MAX];
  uint8_t count;
  uint32_t dropped; /* frames replaced before they were sent, since boot */
} ecu_outbox;

/* Adds the frames of a period, highest priority first, at most ECU_LINK_FRAMES_MAX. They replace
 * the frames of earlier periods, except the oldest OUTBOX_EMERGENCIES_MAX emergencies. */
void outbox_put(ecu_outbox* outbox, const bus_frame* frames, unsigned count);

/* outbox_next: the next frame to send, or null. outbox_sent: removes that frame after it was
 * sent. */
const bus_frame* outbox_next(const ecu_outbox* outbox);
void outbox_sent(ecu_outbox* outbox);

#ifdef __cplusplus
}
#endif
#endif
