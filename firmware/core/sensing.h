/* What a channel's converters say, in SI, and whether it can be believed.
 *
 *   rail           a reading at a converter's end says nothing: the last good one stays for two
 *                  samples, the third is a fault. So with a speed that no supply drives the motor
 *                  to: an encoder that slips must not open the current limit, V = R i + K_E N w
 *   stuck          not one count of change for 100 ms in which the shaft turned: a converter that
 *                  lives is noisy. Looked for from the speed on that the gains say; 0: never
 *   encoder        the motor's equation says that it turns, V = R i + K_E N w, and the encoder that
 *                  it does not, for 50 ms: w above 0.75 R i_limit / (K_E N), seen less than an
 *                  eighth of it. No resistance up to 75 % too high looks like that in a stall
 *   potentiometer  on the same shaft: it and the encoder have come apart by more than the tolerance
 *                  for 50 ms
 */
#ifndef ERP_FIRMWARE_SENSING_H
#define ERP_FIRMWARE_SENSING_H
#include <stdbool.h>
#include <stdint.h>

#include "firmware/core/faults.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ECU_PERIOD_S 0.002f    /* control period: 500 Hz, paper 5.1 */
#define ECU_RAIL_TICKS 3u      /* samples in a row at a converter's rail */
#define ECU_STUCK_TICKS 50u    /* 100 ms of turning without a change */
#define ECU_DISAGREE_TICKS 25u /* 50 ms of two sensors that contradict each other */

/* One reading of the converters. Those of sensors that are not fitted stay 0. */
typedef struct {
  int32_t encoder_counts; /* motor shaft, positive = winding up */
  int16_t current_counts; /* signed, positive = winding up */
  uint16_t tension_counts;
  int32_t potentiometer_counts; /* gearbox shaft, falls when winding up */
  uint16_t temperature_counts;
  uint16_t supply_counts;
} ecu_inputs;

typedef struct {
  /* SI, as last believed */
  float shaft_rad, speed_rad_per_s, current_A, tension_N;
  ecu_inputs inputs; /* of the last tick */
  bool has_inputs;
  /* evidence against a sensor */
  uint32_t rail_ticks;
  uint32_t same_current_ticks, same_tension_ticks;
  uint32_t lag_ticks, apart_ticks;
  bool has_wiper_zero;
  float wiper_zero_rad; /* shaft + potentiometer, when first read */
} ecu_sensed;

/* Takes one reading. `gains` as in parameters.h; `applied_V` is the voltage since the last one.
 * Returns the fault that a sensor has come to, or ECU_FAULT_NONE. */
ecu_fault ecu_sense(ecu_sensed* sensed, const float* gains, const ecu_inputs* inputs,
                    float applied_V);

/* Forgets the evidence, not where the shaft is: what persists is found again. */
void ecu_sensing_clear(ecu_sensed* sensed);

#ifdef __cplusplus
}
#endif
#endif
