/* The parameters that an ECU channel needs before it may be armed. One list gives the enum, the
 * names and the frame indices. Its order is part of the wire format: append only. */
#ifndef ERP_FIRMWARE_PARAMETERS_H
#define ERP_FIRMWARE_PARAMETERS_H

#define ECU_PARAMETERS(X)                                                                    \
  X(SUPPLY, supply_V)                                                                        \
  X(SHAFT_SCALE, shaft_rad_per_count) /* gearbox output per encoder count */                 \
  X(CURRENT_SCALE, current_A_per_count)                                                      \
  X(CURRENT_COUNTS_MAX, current_counts_max) /* a reading at or beyond it is at the rail */   \
  X(TENSION_SCALE, tension_N_per_count)                                                      \
  X(TENSION_COUNTS_MAX, tension_counts_max)                                                  \
  X(RESISTANCE, resistance_ohm)     /* for the current limit: V = R i + K_E N w */           \
  X(BACK_EMF, back_emf_V_s_per_rad) /* at the gearbox output: K_E N */                       \
  X(CURRENT_LIMIT, current_limit_A) /* largest current that a law may drive */               \
  X(CURRENT_TRIP, current_trip_A)   /* trip level */                                         \
  X(TENSION_LIMIT, tension_limit_N) /* set-points above are rejected */                      \
  X(TENSION_TRIP, tension_trip_N)                                                            \
  X(SHAFT_MIN, shaft_min_rad) /* length set-points outside are rejected */                   \
  X(SHAFT_MAX, shaft_max_rad)                                                                \
  X(LENGTH_KP, length_gain_V_per_rad) /* V = kp (shaft_ref - shaft) */                       \
  X(CURRENT_KP, current_gain_V_per_A)                                                        \
  X(CURRENT_KI, current_integral_V_per_A_s)                                                  \
  X(CURRENT_KD, current_derivative_V_s_per_A)                                                \
  X(FORCE_K_CURRENT, force_gain_V_per_A) /* V = P F_ref - k . (i, w, F) */                   \
  X(FORCE_K_SPEED, force_gain_V_s_per_rad)                                                   \
  X(FORCE_K_TENSION, force_gain_V_per_N)                                                     \
  X(FORCE_PREFILTER, force_prefilter_V_per_N)                                                \
  X(TENSION_ZERO, tension_zero_counts)            /* live zero: reading of a slack tendon */ \
  X(CURRENT_STUCK_SPEED, current_stuck_rad_per_s) /* 0: no check for a stuck reading */      \
  X(TENSION_STUCK_SPEED, tension_stuck_rad_per_s)                                            \
  X(WIPER_INPUT, wiper_input)         /* number of the analog input */                       \
  X(WIPER_SCALE, wiper_rad_per_count) /* potentiometer on the gearbox shaft */               \
  X(WIPER_COUNTS_MAX, wiper_counts_max)                                                      \
  X(WIPER_TOLERANCE, wiper_tolerance_rad)       /* 0: none is fitted */                      \
  X(CURRENT_CONTINUOUS, current_continuous_A)   /* permissible continuous motor current */   \
  X(OVERLOAD_LIMIT, overload_A2_s)              /* 0: no check */                            \
  X(TEMPERATURE_SCALE, temperature_C_per_count) /* 0: none is fitted */                      \
  X(TEMPERATURE_ZERO, temperature_zero_C)                                                    \
  X(TEMPERATURE_DERATE, temperature_derate_C)                                                \
  X(TEMPERATURE_TRIP, temperature_trip_C)                                                    \
  X(SUPPLY_SCALE, supply_V_per_count) /* 0: not measured */                                  \
  X(SUPPLY_MIN, supply_min_V)

typedef enum {
#define ECU_PARAMETER_ENUM(id, name) ECU_PARAMETER_##id,
  ECU_PARAMETERS(ECU_PARAMETER_ENUM)
#undef ECU_PARAMETER_ENUM
      ECU_PARAMETER_COUNT
} ecu_parameter_index;

#endif
