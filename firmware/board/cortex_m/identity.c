#include "firmware/board/cortex_m/identity.h"

#define IDENTITY_AT 0x080E0000u
#define IDENTITY_MARK 0x31554345u

bool identity_read(board_fitted* fitted) {
  const volatile uint32_t* page = (const volatile uint32_t*)IDENTITY_AT;
  const uint32_t mark = page[0], what = page[1], serial = page[2];
  fitted->ecu = (uint8_t)what;
  fitted->channels = (uint8_t)(what >> 8) & 3u;
  fitted->analog_inputs = (uint8_t)(what >> 16) & 0xFu;
  fitted->serial = serial & 0xFFFFFFu;
  return mark == IDENTITY_MARK && fitted->ecu < FRAME_ECUS;
}
