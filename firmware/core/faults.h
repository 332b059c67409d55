/* The causes of a trip: one list of the numbers on the bus and the texts of messages.
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
  X(CORRUPT, 6, "consecutive corrupt frames")                                 \
  X(SENSOR_STUCK, 7, "a sensor that no longer changes while the motor turns") \
  X(ENCODER, 8, "the encoder does not count while the motor turns")           \
  X(POTENTIOMETER, 9, "encoder and potentiometer disagree")                   \
  X(OVERLOAD, 10, "motor overload (I2t)")                                     \
  X(OVER_TEMPERATURE, 11, "over-temperature")                                 \
  X(SUPPLY, 12, "supply voltage too low")                                     \
  X(OVERRUN, 13, "consecutive control periods overrun")                       \
  X(BUS_OFF, 14, "its CAN controller is in bus-off")

typedef enum {
#define ECU_FAULT_ENUM(id, number, text) ECU_FAULT_##id = (number),
  ECU_FAULTS(ECU_FAULT_ENUM)
#undef ECU_FAULT_ENUM
      ECU_FAULT_COUNT
} ecu_fault;

#endif
