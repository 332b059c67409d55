/* Helpers of the checks in sensing.c and strain.c; inside firmware/core only. */
#ifndef ERP_FIRMWARE_CHECKS_H
#define ERP_FIRMWARE_CHECKS_H
#include <stdbool.h>
#include <stdint.h>

#include "firmware/core/parameters.h"

/* One parameter of the array `gains` of the calling function. */
#define GAIN(id) (gains[ECU_PARAMETER_##id])

/* Number of consecutive periods with `condition`, given their number before this period. */
static inline uint32_t count_consecutive(bool condition, uint32_t ticks) {
  return condition ? ticks + 1u : 0u;
}

#endif
