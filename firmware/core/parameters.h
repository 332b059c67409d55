/* The numbers an ECU channel is given before it may be armed: one list, from which come the enum,
 * the names and the frame indices. Order is part of the wire format: append only. */
#ifndef ERP_FIRMWARE_PARAMETERS_H
#define ERP_FIRMWARE_PARAMETERS_H

#define ECU_PARAMETERS(X)                                                                  \
  X(SUPPLY, supply_V)                                                                      \
  X(SHAFT_SCALE, shaft_rad_per_count) /* gearbox output per encoder count */               \
  X(CURRENT_SCALE, current_A_per_count)                                                    \
  X(CURRENT_COUNTS_MAX, current_counts_max) /* a reading at or beyond it is at the rail */ \
  X(TENSION_SCALE, tension_N_per_count)                                                    \
  X(TENSION_COUNTS_MAX, tension_counts_max)                                                \
  X(RESISTANCE, resistance_ohm)     /* for the current limit: V = R i + K_E N w */         \
  X(BACK_EMF, back_emf_V_s_per_rad) /* at the gearbox output: K_E N */                     \
  X(CURRENT_LIMIT, current_limit_A) /* what the law may ask for */                         \
  X(CURRENT_TRIP, current_trip_A)   /* where the channel trips */                          \
  X(TENSION_LIMIT, tension_limit_N) /* set-points above are rejected */                    \
  X(TENSION_TRIP, tension_trip_N)                                                          \
  X(SHAFT_MIN, shaft_min_rad) /* length set-points outside are rejected */                 \
  X(SHAFT_MAX, shaft_max_rad)                                                              \
  X(LENGTH_KP, length_gain_V_per_rad) /* V = kp (shaft_ref - shaft) */                     \
  X(CURRENT_KP, current_gain_V_per_A)                                                      \
  X(CURRENT_KI, current_integral_V_per_A_s)                                                \
  X(CURRENT_KD, current_derivative_V_s_per_A)                                              \
  X(FORCE_K_CURRENT, force_gain_V_per_A) /* V = P F_ref - k . (i, w, F) */                 \
  X(FORCE_K_SPEED, force_gain_V_s_per_rad)                                                 \
  X(FORCE_K_TENSION, force_gain_V_per_N)                                                   \
  X(FORCE_PREFILTER, force_prefilter_V_per_N)

typedef enum {
#define ECU_PARAMETER_ENUM(id, name) ECU_PARAMETER_##id,
  ECU_PARAMETERS(ECU_PARAMETER_ENUM)
#undef ECU_PARAMETER_ENUM
      ECU_PARAMETER_COUNT
} ecu_parameter_index;

#endif
