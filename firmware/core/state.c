#include "firmware/core/state.h"

#define BOOT ECU_STATE_BOOT
#define IDLE ECU_STATE_IDLE
#define ARMED ECU_STATE_ARMED
#define RUNNING ECU_STATE_RUNNING
#define FAULT ECU_STATE_FAULT

/* clang-format off */
static const ecu_state table[ECU_STATE_COUNT][ECU_EVENT_COUNT] = {
    /*             commit   off    clear    arm    set-point  trip */
    [BOOT] =    {  IDLE,    BOOT,  BOOT,    BOOT,  BOOT,      BOOT  },
    [IDLE] =    {  IDLE,    IDLE,  IDLE,    ARMED, IDLE,      FAULT },
    [ARMED] =   {  ARMED,   IDLE,  ARMED,   ARMED, RUNNING,   FAULT },
    [RUNNING] = {  RUNNING, IDLE,  RUNNING, ARMED, RUNNING,   FAULT },
    [FAULT] =   {  FAULT,   FAULT, IDLE,    FAULT, FAULT,     FAULT },
};
/* clang-format on */

ecu_state ecu_next_state(ecu_state state, ecu_event event) { return table[state][event]; }

/* In every state except running the channel drives nothing and its law has no memory. */
static void reset_law(ecu_channel* channel) {
  channel->request = channel->state == ARMED ? ECU_REQUEST_ARM : ECU_REQUEST_OFF;
  channel->setpoint = 0;
  channel->duty = 0;
  channel->current_memory = (law_current_memory){0.0f, 0.0f};
}

void ecu_apply(ecu_channel* channel, ecu_event event) {
  const ecu_state next = ecu_next_state(channel->state, event);
  if (next == channel->state) return;
  if (channel->state == FAULT) {
    channel->fault = ECU_FAULT_NONE;
    channel->consecutive_overruns = 0u;
    ecu_sensing_clear(&channel->sensed);
    ecu_strain_clear(&channel->strain);
  }
  channel->state = next;
  channel->bad_setpoints = 0;
  if (next != RUNNING) reset_law(channel);
}
