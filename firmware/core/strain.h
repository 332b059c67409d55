/* Load limits of a channel's motor and ECU.
 *
 *   over-current  |i| above the trip level for two samples, checked on the raw reading, because a
 *                 short circuit drives the converter to its rail
 *   I2t           h' = i^2 - i_continuous^2, never below 0; a fault above the limit, A^2 s
 *   temperature   above `derate` the current limit decreases, to 0 at `trip`; a fault above `trip`
 *                 for 100 ms
 *   supply        below the minimum voltage for 10 ms
 *   tension       above the trip level at once
 */
#ifndef ERP_FIRMWARE_STRAIN_H
#define ERP_FIRMWARE_STRAIN_H
#include "firmware/core/sensing.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ECU_OVER_CURRENT_TICKS 2u /* 4 ms above the trip level */
#define ECU_HOT_TICKS 50u         /* 100 ms above the trip temperature */
#define ECU_LOW_SUPPLY_TICKS 5u   /* 10 ms below the minimum supply voltage */

typedef struct {
  uint32_t over_current_ticks, hot_ticks, low_supply_ticks;
  float heat_A2_s;
} ecu_strain;

/* One period. Returns the detected fault, or ECU_FAULT_NONE. */
ecu_fault ecu_strain_tick(ecu_strain* strain, const float* gains, const ecu_sensed* sensed,
                          const ecu_inputs* inputs);

/* The current limit at the measured temperature, in A. */
float ecu_current_limit_A(const float* gains, const ecu_inputs* inputs);

/* Resets the durations, not the accumulated heat. */
void ecu_strain_clear(ecu_strain* strain);

#ifdef __cplusplus
}
#endif
#endif
