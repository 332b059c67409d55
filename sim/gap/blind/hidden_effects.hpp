#pragma once
#include <map>
#include <string>
#include <vector>

/// Parameters of the hidden effects of a blind robot. Default values have no effect. Equations:
/// channel.cpp, bones.cpp, record.cpp. "Outside": the library of effects lacks this law.
namespace sim::blind {

/// Offset, step and rate in the sensor's unit; gain: relative error; rate: drift per second.
struct SensorEffects {
  double offset = 0, gain = 0, rate = 0;
  double lag_s = 0;                     ///< time constant of a first-order low-pass
  double sine_rad = 0, cosine_rad = 0;  ///< eccentricity of an encoder disc
  double step = 0;                      ///< quantization step
  double curvature = 0;                 ///< outside: reading += curvature · value · |value|
};

struct ChannelEffects {
  // Motor. Relative errors; torque_constant: of K_T and K_E together.
  double resistance = 0, torque_constant = 0, inductance = 0;
  // Warming: thermal resistance and time constant.
  double kelvin_per_W = 0, heat_s = 20;
  double cog_sine_Nm = 0, cog_cosine_Nm = 0;
  // Dead band of the driver, resistance of the supply, delay of the driver (below one period).
  double dead_V = 0, source_ohm = 0, driver_delay_s = 0;
  double saturation_per_A2 = 0;  ///< outside: K_T / (1 + c i²)

  // Gearbox. Added friction; viscous: in N m s/rad; load_fraction: of the load torque.
  double dry_Nm = 0, asymmetric_Nm = 0, viscous = 0, load_fraction = 0;
  double stribeck_Nm = 0, stribeck_rad_per_s = 0.3;
  // Ageing stiction: grows at rest, decays with motion.
  double stiction_Nm = 0, stiction_rest_s = 1, stiction_travel_rad = 0.1;
  // Friction that depends on the shaft angle.
  double turn_sine_Nm = 0, turn_cosine_Nm = 0, turn_periods = 1;
  double backlash_rad = 0, shaft_rad_per_Nm = 0;
  double rotor = 0;     ///< relative error of the rotor's inertia
  double tooth_Nm = 0;  ///< outside: extra friction once per turn of the gearbox

  // Spindle. radius: relative error.
  double radius = 0, growth_m_per_rad = 0, slip_per_N = 0;
  double eccentricity_m = 0;  ///< outside

  // Tendon and its guides.
  double spring = 0;              ///< relative error of the stiffness
  double cubic = 0, damping = 0;  ///< added, in N/m³ and N s/m
  double creep_N_per_m = 0, creep_s = 3;
  double hysteresis_N = 0, hysteresis_m = 5e-4;  ///< yield force, travel of sliding elements (Iwan)
  double length_offset_m = 0;
  double line_m_per_N = 0;             ///< compliance of the line
  double slack_N = 0, slack_m = 1e-3;  ///< outside: straightening braid, F −= a (1 − e^(−x/b))
  double capstan = 0, attachment_shift_m = 0;
  // Relative errors, the last one per metre of change of length.
  double pulley_radius = 0, moment_arm = 0, moment_arm_per_m = 0;
  double snag_N = 0, snag_m = 0;  ///< outside: extra friction of the line at one position

  SensorEffects shaft, current, tension;
};

struct JointEffects {
  // Added friction; viscous: in N m s/rad.
  double dry_Nm = 0, viscous = 0, stribeck_Nm = 0, stribeck_rad_per_s = 0.2;
  double spring = 0, rest_rad = 0;              ///< passive stiffness in Nm/rad, its rest angle
  double early_min_rad = 0, early_max_rad = 0;  ///< distances of early stops from min_rad, max_rad
  double play_rad = 0;                          ///< of the angle sensor
  double drag = 0;                              ///< outside: τ = −c ω |ω|
  double random_Nm = 0;                         ///< outside: standard deviation of a random torque
  SensorEffects angle;
};

struct BodyEffects {
  double mass = 0, inertia = 0;  ///< relative errors
  double com_m = 0;              ///< shift of the centre of mass, outwards
  double payload_kg = 0, bend_rad_per_Nm = 0;
};

struct HiddenEffects {
  double command_delay_s = 0, frame_delay_s = 0, jitter_s = 0;
  double loss = 0;  ///< probability that a command is lost
  double tilt_x_rad = 0, tilt_y_rad = 0;
  std::vector<ChannelEffects> channels;
  std::vector<JointEffects> joints;
  std::map<std::string, BodyEffects> bodies;
};

}  // namespace sim::blind
