/* The four control laws of section 5.1 of the paper; pure functions that compute a voltage.
 * All take and return SI units, single precision. */
#ifndef ERP_FIRMWARE_LAWS_H
#define ERP_FIRMWARE_LAWS_H
#ifdef __cplusplus
extern "C" {
#endif

/* (ii) Line length, P on the motor encoder:  V = kp (shaft_ref - shaft). */
float law_length_V(float gain_V_per_rad, float shaft_ref_rad, float shaft_rad);

/* (iii) Current, PID, with conditional integration at the voltage limit:
 *   V = kp e + ki S e dt + kd de/dt,   e = i_ref - i. */
typedef struct {
  float integral_V;
  float last_error_A;
} law_current_memory;
float law_current_V(law_current_memory* memory, float kp_V_per_A, float ki_V_per_A_s,
                    float kd_V_s_per_A, float error_A, float limit_V, float dt_s);

/* (iv) Tendon force, discrete state feedback on x = (i, w, F) with prefilter:
 *   V = P F_ref - k_i i - k_w w - k_F F. */
typedef struct {
  float current_V_per_A;
  float speed_V_s_per_rad;
  float tension_V_per_N;
  float prefilter_V_per_N;
} law_force_gains;
float law_force_V(const law_force_gains* gains, float force_ref_N, float current_A,
                  float speed_rad_per_s, float tension_N);

/* The voltage nearest to `voltage_V` whose steady-state current stays within +-limit:
 *   R i = V - K_E N w. Limited to the supply. */
float law_limit_current_V(float voltage_V, float speed_rad_per_s, float resistance_ohm,
                          float back_emf_V_s_per_rad, float limit_A, float supply_V);

#ifdef __cplusplus
}
#endif
#endif
