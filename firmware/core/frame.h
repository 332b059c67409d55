/* What an ECU says and hears on CAN: classic frames, 11-bit identifiers, 8 bytes.
 *
 *   identifier = function (4 bits) << 7 | ecu (7 bits)
 *
 * Bit fields are little endian, packed from bit 0 of byte 0; byte 7 is CRC-8 (polynomial 0x2F,
 * AUTOSAR profile) over the identifier's two bytes and bytes 0..6.
 *
 *   COMMAND    host -> ECU   channel 0: request 3, setpoint 22; channel 1: the same; counter 6
 *   STATUS_0/1 ECU -> host   encoder low 16, current 12, tension 12, duty 11, state 2+fault..., counter
 *   HEALTH     ECU -> host   absolute encoder and what each channel follows, slower
 *   ANALOG     ECU -> host   joint sensors
 *   PARAMETER  host -> ECU   channel, index, commit, float32
 */
#ifndef ERP_FIRMWARE_FRAME_H
#define ERP_FIRMWARE_FRAME_H
#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
/* Filled by its room. */
#ifdef __cplusplus
}
#endif
#endif
