/* Helpers shared by sensing.c and strain.c; inside firmware/core only. */
#ifndef ERP_FIRMWARE_EVIDENCE_H
#define ERP_FIRMWARE_EVIDENCE_H
#include <stdbool.h>
#include <stdint.h>

#include "firmware/core/parameters.h"

/* One of the `gains` in scope. */
#define GAIN(id) (gains[ECU_PARAMETER_##id])

/* Counts the consecutive periods in which `holds` is true. */
static inline uint32_t count_if(bool holds, uint32_t ticks) { return holds ? ticks + 1u : 0u; }

#endif
