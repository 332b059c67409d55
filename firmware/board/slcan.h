/* The text protocol of serial CAN adapters (LAWICEL, "slcan"), as used by Linux's slcan driver. An
 * ECU on a serial line behaves like an adapter with one node on its bus.
 *
 *   tIIIDdd…dd\r   a classic frame: identifier of 3 hexadecimal digits, size of 1, its bytes
 *   O\r  C\r       the host opens and closes the channel
 *   Sn\r …         bit rate and similar commands: without effect on a serial line, ignored
 */
#ifndef ERP_FIRMWARE_SLCAN_H
#define ERP_FIRMWARE_SLCAN_H
#include "firmware/core/frame.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SLCAN_LINE_MAX 22u /* t, identifier, size, 16 digits, \r */

typedef enum { SLCAN_NOTHING, SLCAN_FRAME, SLCAN_OPEN, SLCAN_CLOSE } slcan_event;

/* The part of a line read so far. Initialize to zero. */
typedef struct {
  char line[SLCAN_LINE_MAX];
  uint8_t length;
  bool too_long;       /* the rest of the current line is ignored */
  uint32_t unreadable; /* lines that start like a frame but are not one */
} slcan_reader;

/* Processes one byte; `frame` is set when the byte completes a frame. */
slcan_event slcan_take(slcan_reader* reader, uint8_t byte, bus_frame* frame);

/* Writes a frame as text, without terminating null. Returns the length, at most SLCAN_LINE_MAX. */
unsigned slcan_write(char* text, const bus_frame* frame);

#ifdef __cplusplus
}
#endif
#endif
