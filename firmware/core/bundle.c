#include "firmware/core/bundle.h"

#include <string.h>

#define FRAME_BYTES 10u /* identifier 2, data 8 */
#define NO_FRAME 0xFFu

uint8_t bundle_size(unsigned frames) {
  static const uint8_t size[BUNDLE_FRAMES_MAX + 1] = {0, 12, 20, 32, 48, 64, 64};
  return size[frames <= BUNDLE_FRAMES_MAX ? frames : BUNDLE_FRAMES_MAX];
}

bool bundle_accepts(const bus_bundle* bundle, const bus_frame* frame) {
  const bus_frame first = {.id = bundle->id};
  return frame_function_of(frame) == frame_function_of(&first) ||
         frame_ecu_of(frame) == frame_ecu_of(&first);
}

static void put_frame(uint8_t* bytes, const bus_frame* frame) {
  bytes[0] = (uint8_t)(frame->id & 0xFFu);
  bytes[1] = (uint8_t)(frame->id >> 8);
  memcpy(bytes + 2, frame->data, 8);
}

unsigned bundle_pack(bus_bundle* bundle, const bus_frame* frames, unsigned count) {
  unsigned taken = 0;
  bundle->id = frames[0].id;
  memset(bundle->data, NO_FRAME, sizeof bundle->data);
  while (taken < count && taken < BUNDLE_FRAMES_MAX && bundle_accepts(bundle, &frames[taken])) {
    put_frame(bundle->data + taken * FRAME_BYTES, &frames[taken]);
    ++taken;
  }
  bundle->size = bundle_size(taken);
  return taken;
}

unsigned bundle_unpack(const bus_bundle* bundle, bus_frame* frames) {
  const unsigned capacity = bundle->size / FRAME_BYTES;
  unsigned count = 0;
  if (bundle->size > BUNDLE_BYTES_MAX) return 0;
  for (const uint8_t* at = bundle->data; count < capacity && at[1] != NO_FRAME; at += FRAME_BYTES) {
    bus_frame* frame = &frames[count++];
    frame->id = (uint16_t)(at[0] | (unsigned)at[1] << 8);
    frame->size = 8;
    memcpy(frame->data, at + 2, 8);
  }
  return count != 0 && frames[0].id == bundle->id ? count : 0;
}
