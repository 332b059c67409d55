#include "firmware/core/laws.h"

#include <stdbool.h>

static float clamp(float x, float low, float high) { return x < low ? low : x > high ? high : x; }

float law_length_V(float gain_V_per_rad, float shaft_ref_rad, float shaft_rad) {
  return gain_V_per_rad * (shaft_ref_rad - shaft_rad);
}

float law_current_V(law_current_memory* memory, float kp_V_per_A, float ki_V_per_A_s,
                    float kd_V_s_per_A, float error_A, float limit_V, float dt_s) {
  /* V = kp e + (S + ki e dt) + kd (e - e_last) / dt */
  const float integral_V = memory->integral_V + ki_V_per_A_s * error_A * dt_s;
  const float slope_A_per_s = (error_A - memory->last_error_A) / dt_s;
  const float unlimited_V = kp_V_per_A * error_A + integral_V + kd_V_s_per_A * slope_A_per_s;
  const float voltage_V = clamp(unlimited_V, -limit_V, limit_V);
  /* At the limit the integral may change only away from the limit. */
  const bool winds_up =
      (unlimited_V > limit_V && error_A > 0.0f) || (unlimited_V < -limit_V && error_A < 0.0f);
  if (!winds_up) memory->integral_V = clamp(integral_V, -limit_V, limit_V);
  memory->last_error_A = error_A;
  return voltage_V;
}

float law_force_V(const law_force_gains* gains, float force_ref_N, float current_A,
                  float speed_rad_per_s, float tension_N) {
  /* V = P F_ref - k . (i, w, F) */
  return gains->prefilter_V_per_N * force_ref_N - gains->current_V_per_A * current_A -
         gains->speed_V_s_per_rad * speed_rad_per_s - gains->tension_V_per_N * tension_N;
}

float law_limit_current_V(float voltage_V, float speed_rad_per_s, float resistance_ohm,
                          float back_emf_V_s_per_rad, float limit_A, float supply_V) {
  /* R i = V - K_E N w, |i| <= I  =>  K_E N w - R I <= V <= K_E N w + R I */
  const float back_emf_V = back_emf_V_s_per_rad * speed_rad_per_s;
  const float range_V = resistance_ohm * limit_A;
  const float limited_V = clamp(voltage_V, back_emf_V - range_V, back_emf_V + range_V);
  return clamp(limited_V, -supply_V, supply_V);
}
