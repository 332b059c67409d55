/* The text of each ecu_fault; host only, the ECU sends numbers. */
#ifndef ERP_FIRMWARE_FAULT_NAMES_H
#define ERP_FIRMWARE_FAULT_NAMES_H
#include "firmware/core/faults.h"

static inline const char* ecu_fault_name(int fault) {
  switch (fault) {
#define ECU_FAULT_NAME(id, number, text) \
  case number:                           \
    return text;
    ECU_FAULTS(ECU_FAULT_NAME)
#undef ECU_FAULT_NAME
    default:
      return "unknown fault";
  }
}

#endif
