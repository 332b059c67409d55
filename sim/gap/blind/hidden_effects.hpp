#pragma once
#include <map>
#include <string>
#include <vector>

/// What a blind case's robot has beyond its nominal description, as numbers of its own physics.
/// Neutral values change nothing. Meanings: plant.hpp, chain.cpp, senses.hpp.
namespace sim::blind {

struct SensorEffects {
  double offset = 0, gain = 0, rate = 0;  ///< added, share, per second
  double lag_s = 0;                       ///< first order
  double sine_rad = 0, cosine_rad = 0;    ///< of a disc off its centre
  double step = 0;                        ///< coarser steps
  double bend = 0;                        ///< outside the library: said += bend · value²
};

struct ChainEffects {
  double ohm = 0, torque = 0, henry = 0;  ///< shares of R, K_T with K_E, L
  double kelvin_per_W = 0, heat_s = 20;
  double cog_sine_Nm = 0, cog_cosine_Nm = 0;
  double dead_V = 0, source_ohm = 0;
  double driver_late_s = 0;      ///< less than a period
  double saturation_per_A2 = 0;  ///< outside: K_T / (1 + c i²)
  double dry_Nm = 0, one_way_Nm = 0, viscous = 0, load_share = 0;
  double stribeck_Nm = 0, stribeck_rad_per_s = 0.3;
  double stuck_Nm = 0, stuck_after_s = 1, freed_after_rad = 0.1;
  double turn_sine_Nm = 0, turn_cosine_Nm = 0, turn_periods = 1;
  double play_rad = 0, rotor = 0, twist_rad_per_Nm = 0;
  double tooth_Nm = 0;  ///< outside: drags once a turn of the gearbox
  double radius = 0, growth_m_per_rad = 0, slip_per_N = 0;
  double oval_m = 0;  ///< outside: the spindle off its centre
  double spring = 0, cubic = 0, damping = 0;
  double creep_N_per_m = 0, creep_s = 3;
  double fibres_N = 0, fibres_m = 5e-4;  ///< elements that slide
  double knot_m = 0, line_m_per_N = 0;
  double slack_N = 0, slack_m = 1e-3;  ///< outside: a braid that straightens, F −= a (1−e^(−x/b))
  double rub = 0, shift_m = 0, pulley = 0, arm = 0, arm_per_m = 0;
  double snag_N = 0, snag_m = 0;  ///< outside: rubs at one place of its way
  SensorEffects shaft, current, tension;
};

struct JointEffects {
  double dry_Nm = 0, viscous = 0, stribeck_Nm = 0, stribeck_rad_per_s = 0.2;
  double spring = 0, rest_rad = 0;
  double min_in_rad = 0, max_in_rad = 0, loose_rad = 0;
  double drag = 0;      ///< outside: τ = −c ω |ω|
  double gusts_Nm = 0;  ///< outside: pushes that no law foretells
  SensorEffects angle;
};

struct BodyEffects {
  double mass = 0, com_m = 0, inertia = 0, payload_kg = 0, bend_rad_per_Nm = 0;
};

struct HiddenEffects {
  double command_delay_s = 0, frame_delay_s = 0, jitter_s = 0, loss = 0;
  double tilt_x_rad = 0, tilt_y_rad = 0;
  std::vector<ChainEffects> chains;
  std::vector<JointEffects> joints;
  std::map<std::string, BodyEffects> bodies;
};

}  // namespace sim::blind
