/* CAN FD: one frame of up to 64 bytes carries up to six complete classic frames.
 *
 *   bundle identifier = identifier of its first frame
 *   data              = per frame: identifier 16 (low byte first), then its 8 bytes
 *   size              = the next size that CAN FD supports; padding is 0xFF
 *
 * A frame has the same meaning on either bus and carries its own check value. Frames share a bundle
 * if they have the same function (the host's COMMANDs to many ECUs) or come from the same ECU (its
 * frames of one period). A frame of higher priority than the first one begins a new bundle, because
 * the bundle's identifier is its priority.
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

/* True if `frame` may be added to the bundle. */
bool bundle_accepts(const bus_bundle* bundle, const bus_frame* frame);

/* Packs the largest number of first frames that may share a bundle, at least one. Returns their
 * number. */
unsigned bundle_pack(bus_bundle* bundle, const bus_frame* frames, unsigned count);

/* Unpacks into `frames`, room for BUNDLE_FRAMES_MAX. Returns their number; 0: not a valid
 * bundle. */
unsigned bundle_unpack(const bus_bundle* bundle, bus_frame* frames);

#ifdef __cplusplus
}
#endif
#endif
