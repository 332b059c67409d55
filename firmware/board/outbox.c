#include "firmware/board/outbox.h"

static void keep_emergencies(ecu_outbox* outbox) {
  uint8_t emergencies = 0;
  for (uint8_t i = 0; i < outbox->count; ++i) {
    const bool is_emergency = outbox->frames[i].id >> 7 == FRAME_EMERGENCY;
    if (is_emergency && emergencies < OUTBOX_EMERGENCIES_MAX)
      outbox->frames[emergencies++] = outbox->frames[i];
    else ++outbox->dropped;
  }
  outbox->count = emergencies;
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
