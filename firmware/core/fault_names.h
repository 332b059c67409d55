/* What each ecu_fault is called, for people; host only, the ECU sends numbers. */
#ifndef ERP_FIRMWARE_FAULT_NAMES_H
#define ERP_FIRMWARE_FAULT_NAMES_H
#include "firmware/core/ecu.h"

static inline const char* ecu_fault_name(int fault) {
  switch (fault) {
    case ECU_FAULT_NONE: return "no fault";
    case ECU_FAULT_COMMAND_TIMEOUT: return "no command for 50 ms";
    case ECU_FAULT_OVER_CURRENT: return "over-current";
    case ECU_FAULT_OVER_TENSION: return "over-tension";
    case ECU_FAULT_SETPOINT: return "set-points out of range";
    case ECU_FAULT_SENSOR_RANGE: return "a sensor at its rail";
    case ECU_FAULT_CORRUPT: return "corrupt frames in a row";
    default: return "unknown fault";
  }
}

#endif
