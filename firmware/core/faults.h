/* Why a channel tripped: one list that gives the numbers on the bus and the texts for people.
 * Numbers are part of the wire format, four bits: append only. */
#ifndef ERP_FIRMWARE_FAULTS_H
#define ERP_FIRMWARE_FAULTS_H

#define ECU_FAULTS(X)                                                         \
  X(NONE, 0, "no fault")                                                      \
  X(COMMAND_TIMEOUT, 1, "no command for 50 ms")                               \
  X(OVER_CURRENT, 2, "over-current")                                          \
  X(OVER_TENSION, 3, "over-tension")                                          \
  X(SETPOINT, 4, "set-points out of range")                                   \
  X(SENSOR_RANGE, 5, "a sensor at its rail")                                  \
  X(CORRUPT, 6, "corrupt frames in a row")                                    \
  X(SENSOR_STUCK, 7, "a sensor that no longer changes while the motor turns") \
  X(ENCODER, 8, "the encoder does not see the motor turn")                    \
  X(POTENTIOMETER, 9, "encoder and potentiometer have come apart")            \
  X(OVERLOAD, 10, "more current for longer than the motor bears (I2t)")       \
  X(OVER_TEMPERATURE, 11, "over-temperature")                                 \
  X(SUPPLY, 12, "supply voltage too low")                                     \
  X(OVERRUN, 13, "control periods overrun in a row")                          \
  X(BUS_OFF, 14, "its CAN controller went off the bus")

typedef enum {
#define ECU_FAULT_ENUM(id, number, words) ECU_FAULT_##id = (number),
  ECU_FAULTS(ECU_FAULT_ENUM)
#undef ECU_FAULT_ENUM
      ECU_FAULT_COUNT
} ecu_fault;

#endif
