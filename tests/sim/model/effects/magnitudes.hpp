#pragma once
#include <map>
#include <string>
#include <vector>

#include "sim/model/effects/library.hpp"

/// Parameters with which each effect visibly changes the recordings of hinge_rig.
namespace magnitudes {

inline const std::map<std::string, std::map<std::string, double>>& all() {
  static const std::map<std::string, std::map<std::string, double>> values{
      {"bus_command_delay", {{"delay_s", 0.01}}},
      {"bus_sensor_delay", {{"delay_s", 0.01}}},
      {"bus_jitter", {{"spread_s", 0.01}}},
      {"bus_frame_loss", {{"probability", 0.3}}},
      {"motor_resistance", {{"relative", 0.3}}},
      {"motor_torque_constant", {{"relative", -0.05}}},
      {"motor_inductance", {{"relative", 10}}},
      {"motor_thermal_resistance", {{"kelvin_per_W", 30}, {"time_constant_s", 2}}},
      {"motor_cogging", {{"sine_Nm", 1e-3}, {"cosine_Nm", -5e-4}}},
      {"motor_driver_delay", {{"delay_s", 0.001}}},
      {"motor_dead_band", {{"volts", 0.3}}},
      {"motor_supply_sag", {{"source_ohm", 0.5}}},
      {"gearbox_coulomb", {{"extra_Nm", 0.03}}},
      {"gearbox_asymmetric", {{"extra_Nm", 0.02}}},
      {"gearbox_viscous", {{"extra_Nm_s_per_rad", 0.01}}},
      {"gearbox_stribeck", {{"extra_Nm", 0.03}, {"speed_rad_per_s", 0.3}}},
      {"gearbox_ageing_stiction", {{"extra_Nm", 0.2}}},
      {"gearbox_position_dependent", {{"sine_Nm", 0.03}, {"cosine_Nm", 0.02}}},
      {"gearbox_load_dependent", {{"share", 0.2}}},
      {"gearbox_efficiency", {{"relative", -0.15}}},
      {"gearbox_backlash", {{"width_rad", 0.05}}},
      {"gearbox_inertia", {{"relative", 0.5}}},
      {"gearbox_shaft_compliance", {{"rad_per_Nm", 1}}},
      {"spindle_radius", {{"relative", 0.1}}},
      {"spindle_layers", {{"growth_m_per_rad", 1e-4}}},
      {"spindle_slip", {{"per_N", 1e-4}}},
      {"tendon_stiffness", {{"relative", 0.3}}},
      {"tendon_stiffening", {{"cubic_N_per_m3", 5e7}}},
      {"tendon_damping", {{"extra_N_s_per_m", 100}}},
      {"tendon_creep", {{"stiffness_N_per_m", 2000}, {"time_constant_s", 2}}},
      {"tendon_hysteresis", {{"force_N", 2}}},
      {"tendon_length_offset", {{"length_m", 5e-4}}},
      {"tendon_kite_line", {{"compliance_m_per_N", 5e-5}}},
      {"routing_capstan", {{"friction", 0.1}}},
      {"routing_attachment_shift", {{"outwards_m", 0.03}}},
      {"routing_pulley_radius", {{"relative", 0.1}}},
      {"routing_moment_arm", {{"relative", 0.1}, {"relative_per_m", 3}}},
      {"joint_coulomb", {{"extra_Nm", 0.1}}},
      {"joint_viscous", {{"extra_Nm_s_per_rad", 0.05}}},
      {"joint_stribeck", {{"extra_Nm", 0.1}}},
      {"joint_passive_stiffness", {{"stiffness_Nm_per_rad", 0.5}, {"rest_rad", 0.2}}},
      {"joint_early_stop", {{"from_min_rad", 1.1}, {"from_max_rad", 1.3}}},
      {"joint_play", {{"width_rad", 0.02}}},
      {"skeleton_mass", {{"relative", 0.2}}},
      {"skeleton_com", {{"outwards_m", 0.03}}},
      {"skeleton_inertia", {{"relative", 1}}},
      {"skeleton_payload", {{"mass_kg", 0.2}}},
      {"skeleton_base_tilt", {{"about_y_rad", 0.2}}},
      {"skeleton_link_flexibility", {{"compliance_rad_per_Nm", 0.2}}},
      {"sensor_shaft_offset", {{"offset_rad", 0.1}}},
      {"sensor_current_offset", {{"offset_A", 0.1}}},
      {"sensor_tension_offset", {{"offset_N", 2}}},
      {"sensor_joint_offset", {{"offset_rad", 0.05}}},
      {"sensor_shaft_gain", {{"relative", 0.1}}},
      {"sensor_current_gain", {{"relative", 0.1}}},
      {"sensor_tension_gain", {{"relative", 0.1}}},
      {"sensor_joint_gain", {{"relative", 0.1}}},
      {"sensor_shaft_drift", {{"rate_rad_per_s", 0.01}}},
      {"sensor_current_drift", {{"rate_A_per_s", 0.02}}},
      {"sensor_tension_drift", {{"rate_N_per_s", 0.2}}},
      {"sensor_joint_drift", {{"rate_rad_per_s", 0.005}}},
      {"sensor_shaft_low_pass", {{"time_constant_s", 0.01}}},
      {"sensor_current_low_pass", {{"time_constant_s", 0.01}}},
      {"sensor_tension_low_pass", {{"time_constant_s", 0.01}}},
      {"sensor_joint_low_pass", {{"time_constant_s", 0.01}}},
      {"sensor_shaft_eccentricity", {{"sine_rad", 0.1}, {"cosine_rad", 0.1}}},
      {"sensor_joint_eccentricity", {{"sine_rad", 0.03}, {"cosine_rad", 0.03}}},
      {"sensor_shaft_quantisation", {{"step_rad", 0.01}}},
      {"sensor_current_quantisation", {{"step_A", 0.1}}},
      {"sensor_tension_quantisation", {{"step_N", 1}}},
      {"sensor_joint_quantisation", {{"step_rad", 0.01}}}};
  return values;
}

/// The effect with these parameters. Throws std::out_of_range for a type that is not listed above.
inline sim::effects::AnyEffect visible(const std::string& type) {
  auto effect = sim::effects::neutral(type).value();
  for (const auto& [name, value] : all().at(type))
    for (auto& parameter : sim::effects::parameters(effect))
      if (parameter.name == name) *parameter.value = value;
  return effect;
}

/// A suitable target of the effect in hinge_rig.
inline std::string place_in_rig(const sim::effects::AnyEffect& effect) {
  switch (sim::effects::about(effect).seat) {
    case sim::effects::Seat::actuator:
      return "flexor";
    case sim::effects::Seat::joint:
      return "elbow";
    case sim::effects::Seat::body:
      return "forearm";
    case sim::effects::Seat::robot:
      break;
  }
  return "hinge_rig";
}

}  // namespace magnitudes
