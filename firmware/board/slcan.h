/* The text protocol of serial CAN adapters (LAWICEL, "slcan"), which Linux's slcan driver speaks:
 * an ECU on a serial line looks like an adapter with one node behind it.
 *
 *   tIIIDdd…dd\r   a classic frame: identifier of 3 hexadecimal digits, size of 1, its bytes
 *   O\r  C\r       the host opens and closes the channel
 *   Sn\r …         bit rate and the like: of no meaning on a serial line, passed over
 */
#ifndef ERP_FIRMWARE_SLCAN_H
#define ERP_FIRMWARE_SLCAN_H
#include "firmware/core/frame.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SLCAN_LINE_MAX 22u /* t, identifier, size, 16 digits, \r */

typedef enum { SLCAN_NOTHING, SLCAN_FRAME, SLCAN_OPEN, SLCAN_CLOSE } slcan_event;

/* What has been read of a line so far. Zero it first. */
typedef struct {
  char line[SLCAN_LINE_MAX];
  uint8_t have;
  bool too_long;       /* the line at hand is passed over to its end */
  uint32_t unreadable; /* lines that began as a frame and were none */
} slcan_reader;

/* Takes one byte; `frame` is filled when it ends one. */
slcan_event slcan_take(slcan_reader* reader, uint8_t byte, bus_frame* frame);

/* Writes a frame as text, no null at its end. Returns how long, at most SLCAN_LINE_MAX. */
unsigned slcan_write(char* text, const bus_frame* frame);

#ifdef __cplusplus
}
#endif
#endif
