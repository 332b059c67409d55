/* The state machine of a channel as a table; inside firmware/core only. */
#ifndef ERP_FIRMWARE_STATE_H
#define ERP_FIRMWARE_STATE_H
#include "firmware/core/ecu.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
  ECU_EVENT_COMMIT, /* a plausible set of gains takes effect */
  ECU_EVENT_OFF,
  ECU_EVENT_CLEAR,
  ECU_EVENT_ARM,
  ECU_EVENT_SETPOINT, /* a set-point within the limits, of one of the four modes */
  ECU_EVENT_TRIP,
  ECU_EVENT_COUNT
} ecu_event;

/* The state after an event. */
ecu_state ecu_next_state(ecu_state state, ecu_event event);

/* Performs the transition, including the actions on entering the new state. */
void ecu_apply(ecu_channel* channel, ecu_event event);

#ifdef __cplusplus
}
#endif
#endif
