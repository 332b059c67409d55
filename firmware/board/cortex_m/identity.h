/* What a board is, written into the last page of its flash when it is made:
 *
 *   0x080E0000  ECU1 in ASCII, first letter lowest: 0x31554345
 *   0x080E0004  ECU address, channels, analog inputs (as board_fitted), 0: one byte each
 *   0x080E0008  serial number
 */
#ifndef ERP_FIRMWARE_IDENTITY_H
#define ERP_FIRMWARE_IDENTITY_H
#include "firmware/board/board.h"

/* False: none is written, or of an address that no ECU has. Such a board stays silent. */
bool identity_read(board_fitted* fitted);
#endif
