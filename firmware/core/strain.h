/* What a channel puts its motor and its ECU through, and where that ends.
 *
 *   over-current  |i| above the trip level for two samples, judged on the raw reading: a short
 *                 drives the converter to its rail
 *   I2t           h' = i^2 - i_continuous^2, never below 0; a fault above the limit, A^2 s
 *   temperature   from `derate` on the current limit falls, to 0 at `trip`; a fault above that
 *                 for 100 ms
 *   supply        below the least voltage for 10 ms
 *   tension       above the trip level at once
 */
#ifndef ERP_FIRMWARE_STRAIN_H
#define ERP_FIRMWARE_STRAIN_H
#include "firmware/core/sensing.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ECU_OVER_CURRENT_TICKS 2u /* 4 ms over the trip level */
#define ECU_HOT_TICKS 50u         /* 100 ms above the trip temperature */
#define ECU_LOW_SUPPLY_TICKS 5u   /* 10 ms below the least supply voltage */

typedef struct {
  uint32_t over_current_ticks, hot_ticks, low_supply_ticks;
  float heat_A2_s;
} ecu_strain;

/* One period. Returns the fault it has come to, or ECU_FAULT_NONE. */
ecu_fault ecu_strain_tick(ecu_strain* strain, const float* gains, const ecu_sensed* sensed,
                          const ecu_inputs* inputs);

/* What the law may drive at this temperature. */
float ecu_current_limit_A(const float* gains, const ecu_inputs* inputs);

/* Forgets the evidence, not the heat. */
void ecu_strain_clear(ecu_strain* strain);

#ifdef __cplusplus
}
#endif
#endif
