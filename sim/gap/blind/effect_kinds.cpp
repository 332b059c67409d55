#include "sim/gap/blind/effect_kinds.hpp"

#include <cmath>

namespace sim::blind {
namespace {

using Drawn = std::vector<std::pair<std::string, double>>;

double between(Random& r, double low, double high) {
  return std::uniform_real_distribution(low, high)(r);
}
/// The logarithm is uniformly distributed.
double log_uniform(Random& r, double low, double high) {
  return std::exp(between(r, std::log(low), std::log(high)));
}
double sign(Random& r) { return r() & 1 ? 1 : -1; }

ChannelEffects& channel(Place& p) { return p.hidden_effects.channels[p.channel]; }
JointEffects& joint(Place& p) { return p.hidden_effects.joints[p.joint]; }
BodyEffects& body(Place& p) { return p.hidden_effects.bodies[p.body]; }
/// Sets one parameter of a hidden effect.
Drawn set(double& parameter, const char* name, double value) {
  parameter = value;
  return {{name, value}};
}

template <SensorEffects ChannelEffects::*sensor>
SensorEffects& sensor_of(Place& p) {
  return channel(p).*sensor;
}
SensorEffects& angle_of(Place& p) { return joint(p).angle; }

using P = Place;
using R = Random;
constexpr auto on_channel = EffectKind::channel;
constexpr auto on_joint = EffectKind::joint;
constexpr auto on_body = EffectKind::body;
constexpr auto on_link = EffectKind::link;
constexpr auto on_robot = EffectKind::robot;

// clang-format off
const std::vector<EffectKind> library{
  {"bus_command_delay", "bus", on_robot, [](P& p, R& r) { return set(p.hidden_effects.command_delay_s, "delay_s", between(r, 0.004, 0.03)); }, {"bus_sensor_delay"}},
  {"bus_sensor_delay", "bus", on_robot, [](P& p, R& r) { return set(p.hidden_effects.frame_delay_s, "delay_s", between(r, 0.004, 0.03)); }, {"bus_command_delay"}},
  {"bus_jitter", "bus", on_robot, [](P& p, R& r) { return set(p.hidden_effects.jitter_s, "spread_s", between(r, 0.006, 0.04)); }},
  {"bus_frame_loss", "bus", on_robot, [](P& p, R& r) { return set(p.hidden_effects.loss, "probability", between(r, 0.1, 0.7)); }},
  {"motor_resistance", "motor", on_channel, [](P& p, R& r) { return set(channel(p).resistance, "relative", between(r, 0.08, 0.5)); }},
  {"motor_torque_constant", "motor", on_channel, [](P& p, R& r) { return set(channel(p).torque_constant, "relative", sign(r) * between(r, 0.02, 0.12)); }},
  {"motor_inductance", "motor", on_channel, [](P& p, R& r) { return set(channel(p).inductance, "relative", between(r, 5, 20)); }},
  {"motor_thermal_resistance", "motor", on_channel, [](P& p, R& r) { return set(channel(p).kelvin_per_W, "kelvin_per_W", between(r, 20, 80)); }},
  {"motor_cogging", "motor", on_channel, [](P& p, R& r) {
     const double size = between(r, 6e-4, 3e-3), phase = between(r, 0, 6.28);
     channel(p).cog_sine_Nm = size * std::cos(phase), channel(p).cog_cosine_Nm = size * std::sin(phase);
     return Drawn{{"sine_Nm", channel(p).cog_sine_Nm}, {"cosine_Nm", channel(p).cog_cosine_Nm}}; }},
  {"motor_driver_delay", "motor", on_channel, [](P& p, R& r) { return set(channel(p).driver_delay_s, "delay_s", between(r, 6e-4, 1.8e-3)); }},
  {"motor_dead_band", "motor", on_channel, [](P& p, R& r) { return set(channel(p).dead_V, "volts", between(r, 0.1, 0.6)); }},
  {"motor_supply_sag", "motor", on_channel, [](P& p, R& r) { return set(channel(p).source_ohm, "source_ohm", between(r, 0.2, 1.2)); }},
  {"gearbox_coulomb", "gearbox", on_channel, [](P& p, R& r) { return set(channel(p).dry_Nm, "extra_Nm", between(r, 0.02, 0.12)); }, {"gearbox_stribeck"}},
  {"gearbox_asymmetric", "gearbox", on_channel, [](P& p, R& r) {
     const double size = between(r, 0.02, 0.06);
     return set(channel(p).asymmetric_Nm, "extra_Nm", sign(r) * size); }},
  {"gearbox_viscous", "gearbox", on_channel, [](P& p, R& r) { return set(channel(p).viscous, "extra_Nm_s_per_rad", between(r, 0.005, 0.05)); }},
  {"gearbox_stribeck", "gearbox", on_channel, [](P& p, R& r) {
     channel(p).stribeck_Nm = between(r, 0.04, 0.2), channel(p).stribeck_rad_per_s = between(r, 0.2, 1.0);
     return Drawn{{"tustin_Nm", channel(p).stribeck_Nm}, {"tustin_rad_per_s", channel(p).stribeck_rad_per_s}}; }},
  {"gearbox_ageing_stiction", "gearbox", on_channel, [](P& p, R& r) {
     channel(p).stiction_Nm = between(r, 0.1, 0.4), channel(p).stiction_rest_s = log_uniform(r, 0.1, 1), channel(p).stiction_travel_rad = log_uniform(r, 0.1, 0.5);
     return Drawn{{"extra_Nm", channel(p).stiction_Nm}, {"rest_s", channel(p).stiction_rest_s}, {"way_rad", channel(p).stiction_travel_rad}}; }, {"gearbox_stribeck", "gearbox_coulomb"}},
  {"gearbox_position_dependent", "gearbox", on_channel, [](P& p, R& r) {
     const double size = between(r, 0.02, 0.08), phase = between(r, 0, 6.28);
     channel(p).turn_sine_Nm = size * std::cos(phase), channel(p).turn_cosine_Nm = size * std::sin(phase);
     channel(p).turn_periods = std::uniform_int_distribution(1, 12)(r);
     return Drawn{{"sine_Nm", channel(p).turn_sine_Nm}, {"cosine_Nm", channel(p).turn_cosine_Nm}}; }},
  {"gearbox_load_dependent", "gearbox", on_channel, [](P& p, R& r) { return set(channel(p).load_fraction, "share", between(r, 0.15, 0.7)); }, {"routing_capstan"}},
  {"gearbox_backlash", "gearbox", on_channel, [](P& p, R& r) { return set(channel(p).backlash_rad, "width_rad", between(r, 0.05, 0.3)); }},
  {"gearbox_inertia", "gearbox", on_channel, [](P& p, R& r) { return set(channel(p).rotor, "relative", between(r, 0.1, 1.0)); }},
  {"gearbox_shaft_compliance", "gearbox", on_channel, [](P& p, R& r) { return set(channel(p).shaft_rad_per_Nm, "rad_per_Nm", between(r, 0.3, 2)); }, {"tendon_kite_line", "tendon_stiffness"}},
  {"spindle_radius", "spindle", on_channel, [](P& p, R& r) { return set(channel(p).radius, "relative", sign(r) * between(r, 0.03, 0.2)); }},
  {"spindle_layers", "spindle", on_channel, [](P& p, R& r) { return set(channel(p).growth_m_per_rad, "growth_m_per_rad", between(r, 3e-5, 2e-4)); }},
  {"spindle_slip", "spindle", on_channel, [](P& p, R& r) { return set(channel(p).slip_per_N, "per_N", log_uniform(r, 3e-5, 3e-4)); }},
  {"tendon_stiffness", "tendon", on_channel, [](P& p, R& r) { return set(channel(p).spring, "relative", sign(r) * between(r, 0.06, 0.4)); }, {"tendon_kite_line", "gearbox_shaft_compliance"}},
  {"tendon_stiffening", "tendon", on_channel, [](P& p, R& r) { return set(channel(p).cubic, "cubic_N_per_m3", log_uniform(r, 3e7, 3e8)); }},
  {"tendon_damping", "tendon", on_channel, [](P& p, R& r) { return set(channel(p).damping, "extra_N_s_per_m", between(r, 40, 250)); }},
  {"tendon_creep", "tendon", on_channel, [](P& p, R& r) {
     channel(p).creep_N_per_m = between(r, 600, 3000), channel(p).creep_s = log_uniform(r, 0.7, 6);
     return Drawn{{"stiffness_N_per_m", channel(p).creep_N_per_m}, {"time_constant_s", channel(p).creep_s}}; }},
  {"tendon_hysteresis", "tendon", on_channel, [](P& p, R& r) {
     channel(p).hysteresis_N = between(r, 0.8, 4), channel(p).hysteresis_m = log_uniform(r, 2e-4, 1e-3);
     return Drawn{{"fibres_N", channel(p).hysteresis_N}}; }},
  {"tendon_length_offset", "tendon", on_channel, [](P& p, R& r) { return set(channel(p).length_offset_m, "length_m", sign(r) * between(r, 1.5e-4, 1e-3)); }, {"sensor_shaft_offset"}},
  {"tendon_kite_line", "tendon", on_channel, [](P& p, R& r) { return set(channel(p).line_m_per_N, "compliance_m_per_N", between(r, 1e-5, 8e-5)); }, {"tendon_stiffness", "gearbox_shaft_compliance"}},
  {"routing_capstan", "routing", on_channel, [](P& p, R& r) { return set(channel(p).capstan, "friction", between(r, 0.08, 0.3)); }, {"gearbox_load_dependent"}},
  {"routing_pulley_radius", "routing", on_channel, [](P& p, R& r) { return set(channel(p).pulley_radius, "relative", sign(r) * between(r, 0.04, 0.2)); }, {"routing_moment_arm"}},
  {"routing_moment_arm", "routing", on_channel, [](P& p, R& r) {
     channel(p).moment_arm = sign(r) * between(r, 0.03, 0.15), channel(p).moment_arm_per_m = sign(r) * between(r, 1, 5);
     return Drawn{{"relative", channel(p).moment_arm}, {"relative_per_m", channel(p).moment_arm_per_m}}; }},
  {"joint_coulomb", "joint", on_joint, [](P& p, R& r) { return set(joint(p).dry_Nm, "extra_Nm", p.relative_load * between(r, 0.06, 0.25)); }, {"joint_stribeck"}},
  {"joint_viscous", "joint", on_joint, [](P& p, R& r) { return set(joint(p).viscous, "extra_Nm_s_per_rad", p.relative_load * between(r, 0.05, 0.3)); }},
  {"joint_stribeck", "joint", on_joint, [](P& p, R& r) {
     joint(p).stribeck_Nm = p.relative_load * between(r, 0.12, 0.4), joint(p).stribeck_rad_per_s = between(r, 0.15, 0.6);
     return Drawn{{"tustin_Nm", joint(p).stribeck_Nm}, {"tustin_rad_per_s", joint(p).stribeck_rad_per_s}}; }},
  {"joint_passive_stiffness", "joint", on_joint, [](P& p, R& r) {
     joint(p).spring = p.relative_load * between(r, 0.2, 1.5), joint(p).rest_rad = between(r, -0.5, 0.8);
     return Drawn{{"stiffness_Nm_per_rad", joint(p).spring}, {"rest_rad", joint(p).rest_rad}}; }},
  {"joint_early_stop", "joint", on_joint, [](P& p, R& r) {
     const double a = between(r, 0.3, 0.8);
     if (r() & 1) return set(joint(p).early_min_rad, "from_min_rad", a);
     return set(joint(p).early_max_rad, "from_max_rad", a); }},
  {"joint_play", "joint", on_joint, [](P& p, R& r) { return set(joint(p).play_rad, "width_rad", between(r, 0.01, 0.06)); }},
  {"skeleton_mass", "skeleton", on_body, [](P& p, R& r) { return set(body(p).mass, "relative", sign(r) * between(r, 0.15, 0.5)); }, {"skeleton_payload", "skeleton_com"}},
  {"skeleton_com", "skeleton", on_body, [](P& p, R& r) { return set(body(p).com_m, "outwards_m", sign(r) * between(r, 0.02, 0.05)); }, {"skeleton_payload", "skeleton_mass"}},
  {"skeleton_inertia", "skeleton", on_body, [](P& p, R& r) { return set(body(p).inertia, "relative", between(r, 0.8, 3)); }},
  {"skeleton_payload", "skeleton", on_body, [](P& p, R& r) { return set(body(p).payload_kg, "mass_kg", p.relative_load * between(r, 0.12, 0.5)); }, {"skeleton_com", "skeleton_mass"}},
  {"skeleton_base_tilt", "skeleton", on_robot, [](P& p, R& r) { return set(p.hidden_effects.tilt_y_rad, "about_y_rad", sign(r) * between(r, 0.06, 0.3)); }},
  {"skeleton_link_flexibility", "skeleton", on_link, [](P& p, R& r) { return set(body(p).bend_rad_per_Nm, "compliance_rad_per_Nm", between(r, 0.05, 0.3) / p.relative_load); }},
  {"sensor_shaft_offset", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::shaft>(p).offset, "offset_rad", sign(r) * between(r, 0.03, 0.2)); }, {"tendon_length_offset"}},
  {"sensor_current_offset", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::current>(p).offset, "offset_A", sign(r) * between(r, 0.04, 0.3)); }},
  {"sensor_tension_offset", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::tension>(p).offset, "offset_N", between(r, 0.5, 4)); }},
  {"sensor_joint_offset", "sensor", on_joint, [](P& p, R& r) { return set(angle_of(p).offset, "offset_rad", sign(r) * between(r, 0.02, 0.1)); }},
  {"sensor_shaft_gain", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::shaft>(p).gain, "relative", sign(r) * between(r, 0.02, 0.1)); }},
  {"sensor_current_gain", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::current>(p).gain, "relative", sign(r) * between(r, 0.05, 0.25)); }},
  {"sensor_tension_gain", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::tension>(p).gain, "relative", sign(r) * between(r, 0.04, 0.2)); }},
  {"sensor_joint_gain", "sensor", on_joint, [](P& p, R& r) { return set(angle_of(p).gain, "relative", sign(r) * between(r, 0.02, 0.12)); }, {"sensor_joint_eccentricity"}},
  {"sensor_shaft_drift", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::shaft>(p).rate, "rate_rad_per_s", sign(r) * between(r, 0.005, 0.03)); }},
  {"sensor_current_drift", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::current>(p).rate, "rate_A_per_s", sign(r) * between(r, 0.006, 0.04)); }},
  {"sensor_tension_drift", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::tension>(p).rate, "rate_N_per_s", between(r, 0.08, 0.4)); }},
  {"sensor_joint_drift", "sensor", on_joint, [](P& p, R& r) { return set(angle_of(p).rate, "rate_rad_per_s", sign(r) * between(r, 0.002, 0.01)); }},
  {"sensor_shaft_low_pass", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::shaft>(p).lag_s, "time_constant_s", between(r, 0.002, 0.01)); }},
  {"sensor_current_low_pass", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::current>(p).lag_s, "time_constant_s", between(r, 0.005, 0.03)); }},
  {"sensor_tension_low_pass", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::tension>(p).lag_s, "time_constant_s", between(r, 0.008, 0.03)); }},
  {"sensor_joint_low_pass", "sensor", on_joint, [](P& p, R& r) { return set(angle_of(p).lag_s, "time_constant_s", between(r, 0.005, 0.03)); }},
  {"sensor_shaft_eccentricity", "sensor", on_channel, [](P& p, R& r) {
     auto& s = sensor_of<&ChannelEffects::shaft>(p); const double size = between(r, 0.08, 0.25), phase = between(r, 0, 6.28);
     s.sine_rad = size * std::cos(phase), s.cosine_rad = size * std::sin(phase);
     return Drawn{{"sine_rad", s.sine_rad}, {"cosine_rad", s.cosine_rad}}; }},
  {"sensor_joint_eccentricity", "sensor", on_joint, [](P& p, R& r) {
     auto& s = angle_of(p); const double size = between(r, 0.03, 0.12), phase = between(r, 0, 6.28);
     s.sine_rad = size * std::cos(phase), s.cosine_rad = size * std::sin(phase);
     return Drawn{{"sine_rad", s.sine_rad}, {"cosine_rad", s.cosine_rad}}; }},
  {"sensor_shaft_quantisation", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::shaft>(p).step, "step_rad", log_uniform(r, 1e-3, 0.02)); }},
  {"sensor_current_quantisation", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::current>(p).step, "step_A", log_uniform(r, 0.08, 0.5)); }},
  {"sensor_tension_quantisation", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::tension>(p).step, "step_N", log_uniform(r, 0.5, 3)); }},
  {"sensor_joint_quantisation", "sensor", on_joint, [](P& p, R& r) { return set(angle_of(p).step, "step_rad", log_uniform(r, 4e-3, 0.03)); }},
};

const std::vector<EffectKind> outside{
  {"outside_saturation", "motor", on_channel, [](P& p, R& r) { return set(channel(p).saturation_per_A2, "per_A2", between(r, 0.04, 0.12)); }},
  {"outside_bad_tooth", "gearbox", on_channel, [](P& p, R& r) { return set(channel(p).tooth_Nm, "Nm", between(r, 0.1, 0.4)); }},
  {"outside_oval_spindle", "spindle", on_channel, [](P& p, R& r) { return set(channel(p).eccentricity_m, "m", between(r, 2e-4, 6e-4)); }},
  {"outside_straightening", "tendon", on_channel, [](P& p, R& r) {
     channel(p).slack_m = between(r, 5e-4, 2e-3);
     return set(channel(p).slack_N, "N", between(r, 2, 6)); }},
  {"outside_snag", "routing", on_channel, [](P& p, R& r) {
     channel(p).snag_m = between(r, -0.015, 0.015);
     return set(channel(p).snag_N, "N", between(r, 8, 25)); }},
  {"outside_drag", "joint", on_joint, [](P& p, R& r) { return set(joint(p).drag, "Nm_s2", p.relative_load * between(r, 0.03, 0.12)); }},
  {"outside_gusts", "joint", on_joint, [](P& p, R& r) { return set(joint(p).random_Nm, "Nm", p.relative_load * between(r, 0.15, 0.5)); }},
  {"outside_bent_current", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::current>(p).curvature, "per_A", between(r, 0.06, 0.2)); }},
  {"outside_bent_tension", "sensor", on_channel, [](P& p, R& r) { return set(sensor_of<&ChannelEffects::tension>(p).curvature, "per_N", between(r, 0.004, 0.012)); }},
};
// clang-format on

}  // namespace

std::span<const EffectKind> in_library() { return library; }
std::span<const EffectKind> outside_library() { return outside; }

}  // namespace sim::blind
