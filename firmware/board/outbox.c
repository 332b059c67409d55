#include "firmware/board/outbox.h"

static void keep_emergencies(ecu_outbox* outbox) {
  uint8_t kept = 0;
  for (uint8_t i = 0; i < outbox->count; ++i) {
    const bool urgent = outbox->frames[i].id >> 7 == FRAME_EMERGENCY;
    if (urgent && kept < OUTBOX_EMERGENCIES_MAX) outbox->frames[kept++] = outbox->frames[i];
    else ++outbox->dropped;
  }
  outbox->count = kept;
}

void outbox_put(ecu_outbox* outbox, const bus_frame* frames, unsigned count) {
  keep_emergencies(outbox);
  for (unsigned i = 0; i < count && i < ECU_LINK_FRAMES_MAX; ++i)
    outbox->frames[outbox->count++] = frames[i];
}

const bus_frame* outbox_next(const ecu_outbox* outbox) {
  return outbox->count > 0 ? &outbox->frames[0] : 0;
}

void outbox_sent(ecu_outbox* outbox) {
  if (outbox->count == 0) return;
  --outbox->count;
  for (uint8_t i = 0; i < outbox->count; ++i) outbox->frames[i] = outbox->frames[i + 1u];
}
