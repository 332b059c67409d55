/* Conversion of a channel's converter readings to SI units, and detection of sensor faults.
 *
 *   rail           a reading at the end of a converter's range carries no information: the last valid
 *                  reading is kept for two samples, the third is a fault. The same holds for a speed
 *                  that no supply voltage can drive: an encoder that slips must not raise the
 *                  current limit, V = R i + K_E N w
 *   stuck          the reading does not change by one count for 100 ms in which the shaft turns; a
 *                  working converter is noisy. Checked above the speed given by the gains; 0: never
 *   encoder        for 50 ms the motor equation V = R i + K_E N w shows a rotation that the encoder
 *                  does not show: w above 0.75 R i_limit / (K_E N), measured less than
 *                  an eighth of it. A stalled motor does not trip this check, even if the
 *                  configured resistance is up to 75 % too high
 *   potentiometer  on the same shaft: its difference from the encoder exceeds the tolerance for
 *                  50 ms
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
#define ECU_RAIL_TICKS 3u      /* consecutive samples at a converter's rail */
#define ECU_STUCK_TICKS 50u    /* 100 ms of rotation without a change */
#define ECU_DISAGREE_TICKS 25u /* 50 ms of contradiction between two sensors */

/* One reading of all converters. Values of sensors that are not fitted stay 0. */
typedef struct {
  int32_t encoder_counts; /* motor shaft, positive = winding up */
  int16_t current_counts; /* signed, positive = winding up */
  uint16_t tension_counts;
  int32_t potentiometer_counts; /* gearbox shaft, decreases when winding up */
  uint16_t temperature_counts;
  uint16_t supply_counts;
} ecu_inputs;

typedef struct {
  /* SI, last valid values */
  float shaft_rad, speed_rad_per_s, current_A, tension_N;
  ecu_inputs inputs; /* of the last tick */
  bool has_inputs;
  /* durations of suspicious readings */
  uint32_t rail_ticks;
  uint32_t same_current_ticks, same_tension_ticks;
  uint32_t lag_ticks, disagree_ticks;
  bool has_wiper_zero;
  float wiper_zero_rad; /* shaft + potentiometer at the first reading */
} ecu_sensed;

/* Processes one reading. `gains` as in parameters.h; `applied_V`: the voltage since the last
 * reading. Returns the detected sensor fault, or ECU_FAULT_NONE. */
ecu_fault ecu_sense(ecu_sensed* sensed, const float* gains, const ecu_inputs* inputs,
                    float applied_V);

/* Resets the durations, not the shaft position; a persistent fault is detected again. */
void ecu_sensing_clear(ecu_sensed* sensed);

#ifdef __cplusplus
}
#endif
#endif
