/* One actuator channel of an electronic control unit: state machine, safety, control laws.
 *
 *   every 2 ms:  duty = ecu_tick(&channel, &inputs)        reads converters, returns PWM
 *   on a frame:  ecu_command(&channel, request, setpoint)  what to follow next
 *   on a frame:  ecu_parameter(&channel, index, value, commit)
 *
 * C11, no heap, no OS, no library but <stdint.h>, <stdbool.h>; single-precision arithmetic.
 * The same object code runs on the microcontroller, in the virtual ECU and in the simulator.
 *
 *   boot --gains committed--> idle --arm--> armed --set-point--> running
 *            any --fault--> fault (PWM 0, latched) --clear--> idle
 *            armed, running --off--> idle
 */
#ifndef ERP_FIRMWARE_ECU_H
#define ERP_FIRMWARE_ECU_H
#include <stdbool.h>
#include <stdint.h>

#include "firmware/core/parameters.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ECU_PERIOD_S 0.002f      /* control period: 500 Hz, paper 5.1 */
#define ECU_DUTY_MAX 1023        /* PWM counts at full supply, either sign */
#define ECU_WARN_TICKS 10u       /* 20 ms without a command: warn */
#define ECU_TIMEOUT_TICKS 25u    /* 50 ms without a command: trip */

typedef enum {
  ECU_STATE_BOOT = 0,
  ECU_STATE_IDLE = 1,
  ECU_STATE_ARMED = 2,
  ECU_STATE_RUNNING = 3,
  ECU_STATE_FAULT = 4
} ecu_state;

typedef enum {
  ECU_FAULT_NONE = 0,
  ECU_FAULT_COMMAND_TIMEOUT = 1,
  ECU_FAULT_OVER_CURRENT = 2,
  ECU_FAULT_OVER_TENSION = 3,
  ECU_FAULT_SETPOINT = 4,      /* out of range or of an unknown request, several in a row */
  ECU_FAULT_SENSOR_RANGE = 5,  /* a converter at its rail */
  ECU_FAULT_CORRUPT = 6        /* several corrupt frames in a row */
} ecu_fault;

/* What a command asks; set-points are integers in the quantum given. */
typedef enum {
  ECU_REQUEST_OFF = 0,
  ECU_REQUEST_CLEAR = 1,    /* leave fault */
  ECU_REQUEST_ARM = 2,      /* ready, PWM 0 */
  ECU_REQUEST_VOLTAGE = 3,  /* mV */
  ECU_REQUEST_LENGTH = 4,   /* encoder counts; P law on the motor encoder */
  ECU_REQUEST_CURRENT = 5,  /* mA; PID */
  ECU_REQUEST_FORCE = 6     /* mN; state space with prefilter */
} ecu_request;

/* One reading of the converters. */
typedef struct {
  int32_t encoder_counts;   /* motor shaft, positive = winding up */
  int16_t current_counts;   /* signed, positive = winding up */
  uint16_t tension_counts;
} ecu_inputs;

typedef struct {
  ecu_state state;
  ecu_fault fault;
  ecu_request request;             /* what it follows */
  int32_t setpoint;
  uint32_t ticks_since_command;
  bool command_seen;
  uint32_t bad_setpoints;          /* in a row */
  uint32_t rejected_setpoints;     /* ever */
  float gains[ECU_PARAMETER_COUNT];        /* in force */
  float gains_staged[ECU_PARAMETER_COUNT]; /* written, not yet committed */
  bool gains_complete;
  uint32_t written_low, written_high;      /* bits: parameters written since boot */
  /* measured, SI */
  float shaft_rad, speed_rad_per_s, current_A, tension_N;
  int32_t last_encoder_counts;
  bool has_last_encoder;
  /* memory of the laws */
  float current_integral_V, last_current_error_A;
  int16_t duty;
  uint32_t rail_ticks, over_current_ticks;
} ecu_channel;

void ecu_init(ecu_channel* channel);

/* A fresh, checked command. Returns false when it was rejected (the old one stays, and times out). */
bool ecu_command(ecu_channel* channel, ecu_request request, int32_t setpoint);

/* Stages one parameter; with `commit` the staged set comes into force as a whole, if every
 * parameter has been written once and the set is sane. Returns false when it was rejected. */
bool ecu_parameter(ecu_channel* channel, uint8_t index, float value, bool commit);

/* One control period. Returns the PWM duty, -ECU_DUTY_MAX .. ECU_DUTY_MAX. */
int16_t ecu_tick(ecu_channel* channel, const ecu_inputs* inputs);

/* Forces the fault state from outside (corrupt frames, watchdogs). */
void ecu_trip(ecu_channel* channel, ecu_fault fault);

#ifdef __cplusplus
}
#endif
#endif
