#include "firmware/board/cortex_m/identity.h"

#define IDENTITY_ADDRESS 0x080E0000u
#define IDENTITY_MARK 0x31554345u /* ECU1 */

bool identity_read(board_fitted* fitted) {
  const volatile uint32_t* page = (const volatile uint32_t*)IDENTITY_ADDRESS;
  const uint32_t mark = page[0], equipment = page[1], serial = page[2];
  fitted->ecu = (uint8_t)equipment;
  fitted->channels = (uint8_t)(equipment >> 8) & 3u;
  fitted->analog_inputs = (uint8_t)(equipment >> 16) & 0xFu;
  fitted->serial = serial & 0xFFFFFFu;
  return mark == IDENTITY_MARK && fitted->ecu < FRAME_ECUS;
}
