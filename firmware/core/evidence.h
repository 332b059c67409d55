/* What judging sensors and strain has in common; inside firmware/core only. */
#ifndef ERP_FIRMWARE_EVIDENCE_H
#define ERP_FIRMWARE_EVIDENCE_H
#include <stdbool.h>
#include <stdint.h>

#include "firmware/core/parameters.h"

/* One of the `gains` in scope. */
#define GAIN(id) (gains[ECU_PARAMETER_##id])

/* Periods in a row for which something holds. */
static inline uint32_t count_if(bool holds, uint32_t ticks) { return holds ? ticks + 1u : 0u; }

#endif
