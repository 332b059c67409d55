/* One actuator channel of an electronic control unit: state machine, safety, control laws.
 *
 *   every 2 ms:  duty = ecu_tick(&channel, &inputs)        reads converters, returns PWM
 *   on a frame:  ecu_command(&channel, request, setpoint)  request and set-point to apply
 *   on a frame:  ecu_parameter(&channel, index, value, commit)  gains and the encoder's zero
 *
 * C11, no heap, no OS, no library but <stdint.h>, <stdbool.h>; single-precision arithmetic.
 * The same source runs on the microcontroller, in the process `ecu` and in the simulator.
 *
 *   boot --gains committed--> idle --arm--> armed --set-point--> running --arm--> armed
 *            idle, armed, running --fault--> fault (PWM 0, latched) --clear--> idle
 *            armed, running --off--> idle
 *
 * In boot no fault can occur, because there are no gains for the checks of readings, and PWM is 0.
 */
#ifndef ERP_FIRMWARE_ECU_H
#define ERP_FIRMWARE_ECU_H
#include <stdbool.h>
#include <stdint.h>

#include "firmware/core/laws.h"
#include "firmware/core/parameters.h"
#include "firmware/core/sensing.h"
#include "firmware/core/strain.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ECU_DUTY_MAX 1023         /* PWM counts at full supply, either sign; chosen: 11 bits */
#define ECU_WARN_TICKS 10u        /* 20 ms without a command: warning */
#define ECU_TIMEOUT_TICKS 25u     /* 50 ms without a command: trip */
#define ECU_BAD_SETPOINTS_TRIP 5u /* consecutive set-points out of range */
#define ECU_OVERRUNS_TRIP 3u      /* consecutive control periods that were overrun */

typedef enum {
  ECU_STATE_BOOT = 0,
  ECU_STATE_IDLE = 1,
  ECU_STATE_ARMED = 2,
  ECU_STATE_RUNNING = 3,
  ECU_STATE_FAULT = 4,
  ECU_STATE_COUNT
} ecu_state;

/* The request of a command; set-points are integers in the unit given. A request is a level, not an
 * edge: the host repeats it every period, and repetition is harmless. */
typedef enum {
  ECU_REQUEST_OFF = 0,
  ECU_REQUEST_CLEAR = 1,   /* leave fault; the set-point is the ecu_fault to clear */
  ECU_REQUEST_ARM = 2,     /* ready, PWM 0 */
  ECU_REQUEST_VOLTAGE = 3, /* mV */
  ECU_REQUEST_LENGTH = 4,  /* encoder counts; P law on the motor encoder */
  ECU_REQUEST_CURRENT = 5, /* mA; PID */
  ECU_REQUEST_FORCE = 6    /* mN; state space with prefilter */
} ecu_request;

typedef struct {
  ecu_state state;
  ecu_fault fault;
  ecu_request request; /* in effect; off in boot, idle and fault, arm when armed */
  int32_t setpoint;    /* 0 unless running */
  uint32_t ticks_since_command;
  uint32_t bad_setpoints;                  /* consecutive */
  uint32_t rejected_setpoints;             /* since initialization */
  uint32_t rejected_commits;               /* since initialization */
  uint32_t accepted_commits;               /* since initialization */
  float gains[ECU_PARAMETER_COUNT];        /* in effect */
  float gains_staged[ECU_PARAMETER_COUNT]; /* written, not yet committed */
  uint64_t written;                        /* bits: parameters staged or in effect */
  bool staged_invalid;                     /* a value of the staged set was rejected or lost */
  bool gains_complete;                     /* a set is in effect */
  ecu_sensed sensed;
  ecu_strain strain;
  law_current_memory current_memory;
  int16_t duty;
  uint32_t overruns;             /* since initialization */
  uint32_t consecutive_overruns; /* control periods */
  bool zero_known;               /* the zero was set since the reset */
  int32_t zero_counts;           /* added to the encoder's counts; 0 until the zero is set */
} ecu_channel;

void ecu_init(ecu_channel* channel);

/* Processes a fresh command. Returns false when it is not accepted. A set-point outside the limits
 * or an unknown request is counted, and the previous set-point stays in effect until it times out;
 * five consecutive ones trip. A mode request in boot, idle or fault is counted and ignored; arm in
 * boot or fault is ignored. */
bool ecu_command(ecu_channel* channel, ecu_request request, int32_t setpoint);

/* Stages one parameter. With `commit` the staged set takes effect as a whole, if every parameter
 * has been written once and the set is plausible (is_sane in gains.c). Returns false when the
 * parameter or the set is rejected. Then no value of the set takes effect, all further values up to
 * the commit are rejected, and the set must be written again. */
bool ecu_parameter(ecu_channel* channel, uint8_t index, float value, bool commit);

/* Drops the values staged since the last commit; a new set begins. */
void ecu_discard_parameters(ecu_channel* channel);

/* Sets the encoder's zero: from now on the position is the counts since the reset plus `counts`.
 * After a reset the encoder starts at 0 wherever the shaft is, so the zero is unknown until the host
 * has determined it. Speeds do not change. Returns false, without effect, while the channel follows a
 * length set-point. As a parameter: index ECU_ZERO, effective without commit; NaN: unknown. */
bool ecu_set_zero(ecu_channel* channel, bool known, int32_t counts);
#define ECU_ZERO 62u         /* index on the bus; not one of the gains */
#define ECU_ZERO_MAX 8388607 /* counts; exact in float32; 4 times the range of set-points */

/* Reports that a value of the staged set was lost in transit: its commit will be rejected. */
void ecu_invalidate_staged(ecu_channel* channel);

/* One control period. The encoder counts of `converters` start at 0 at the reset. Returns the PWM
 * duty, -ECU_DUTY_MAX .. ECU_DUTY_MAX. */
int16_t ecu_tick(ecu_channel* channel, const ecu_inputs* converters);

/* Forces the fault state from outside (corrupt frames, watchdogs). The first cause is kept. */
void ecu_trip(ecu_channel* channel, ecu_fault fault);

/* To be called once per period. `overran`: the control loop of the previous period was still
 * running when this one began. The third consecutive such period trips. */
void ecu_overran(ecu_channel* channel, bool overran);

/* Armed or running, and 20 ms or more without a command. */
bool ecu_is_warning(const ecu_channel* channel);

#ifdef __cplusplus
}
#endif
#endif
