/* Address and equipment of a board, written into the last page of its flash at production:
 *
 *   0x080E0000  ECU1 in ASCII, first letter lowest: 0x31554345
 *   0x080E0004  ECU address, channels, analog inputs (as board_fitted), 0: one byte each
 *   0x080E0008  serial number
 */
#ifndef ERP_FIRMWARE_IDENTITY_H
#define ERP_FIRMWARE_IDENTITY_H
#include "firmware/board/board.h"

/* False: no identity is written, or its address is invalid. Such a board sends nothing. */
bool identity_read(board_fitted* fitted);
#endif
