/* CAN FD: one frame of up to 64 bytes carries up to six classic ones, whole.
 *
 *   bundle identifier = identifier of the first frame in it
 *   data              = per frame: identifier 16 (low byte first), then its 8 bytes
 *   size              = the next one that CAN FD has; what is left over is 0xFF
 *
 * So a frame means the same on either bus, and carries its own check value. Frames go together
 * that are of one function (the host's COMMANDs to many ECUs) or of one ECU (all it says in a
 * period); one that is more urgent begins a bundle, for the identifier is its priority.
 */
#ifndef ERP_FIRMWARE_BUNDLE_H
#define ERP_FIRMWARE_BUNDLE_H
#include "firmware/core/frame.h"

#ifdef __cplusplus
extern "C" {
#endif

#define BUNDLE_FRAMES_MAX 6u
#define BUNDLE_BYTES_MAX 64u

typedef struct {
  uint16_t id;
  uint8_t size;
  uint8_t data[BUNDLE_BYTES_MAX];
} bus_bundle;

/* The size on the bus of a bundle of `frames`, 1 to BUNDLE_FRAMES_MAX: 12, 20, 32, 48, 64, 64. */
uint8_t bundle_size(unsigned frames);

/* Whether `frame` may go with those in the bundle. */
bool bundle_takes(const bus_bundle* bundle, const bus_frame* frame);

/* Packs the first frames of `frames` that go together, at least one. Returns how many. */
unsigned bundle_pack(bus_bundle* bundle, const bus_frame* frames, unsigned count);

/* Unpacks into `frames`, room for BUNDLE_FRAMES_MAX. Returns how many; 0: no bundle of ours. */
unsigned bundle_unpack(const bus_bundle* bundle, bus_frame* frames);

#ifdef __cplusplus
}
#endif
#endif
