#include "sim/gap/blind/effect_kinds.hpp"

#include <cmath>

namespace sim::blind {
namespace {

using Drawn = std::vector<std::pair<std::string, double>>;

double between(Random& r, double low, double high) {
  return std::uniform_real_distribution(low, high)(r);
}
/// Uniform in its logarithm.
double scale(Random& r, double low, double high) {
  return std::exp(between(r, std::log(low), std::log(high)));
}
double sign(Random& r) { return r() & 1 ? 1 : -1; }

ChainEffects& chain(Place& p) { return p.hidden_effects.chains[p.chain]; }
JointEffects& joint(Place& p) { return p.hidden_effects.joints[p.joint]; }
BodyEffects& body(Place& p) { return p.hidden_effects.bodies[p.body]; }
/// Sets one parameter of a hidden effect.
Drawn set(double& parameter, const char* name, double value) {
  parameter = value;
  return {{name, value}};
}

template <SensorEffects ChainEffects::*sense>
SensorEffects& sense_of(Place& p) {
  return chain(p).*sense;
}
SensorEffects& angle_of(Place& p) { return joint(p).angle; }

using P = Place;
using R = Random;
constexpr auto on_chain = EffectKind::chain;
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
  {"motor_resistance", "motor", on_chain, [](P& p, R& r) { return set(chain(p).resistance, "relative", between(r, 0.08, 0.5)); }},
  {"motor_torque_constant", "motor", on_chain, [](P& p, R& r) { return set(chain(p).torque_constant, "relative", sign(r) * between(r, 0.02, 0.12)); }},
  {"motor_inductance", "motor", on_chain, [](P& p, R& r) { return set(chain(p).inductance, "relative", between(r, 5, 20)); }},
  {"motor_thermal_resistance", "motor", on_chain, [](P& p, R& r) { return set(chain(p).kelvin_per_W, "kelvin_per_W", between(r, 20, 80)); }},
  {"motor_cogging", "motor", on_chain, [](P& p, R& r) {
     const double size = between(r, 6e-4, 3e-3), phase = between(r, 0, 6.28);
     chain(p).cog_sine_Nm = size * std::cos(phase), chain(p).cog_cosine_Nm = size * std::sin(phase);
     return Drawn{{"sine_Nm", chain(p).cog_sine_Nm}, {"cosine_Nm", chain(p).cog_cosine_Nm}}; }},
  {"motor_driver_delay", "motor", on_chain, [](P& p, R& r) { return set(chain(p).driver_late_s, "delay_s", between(r, 6e-4, 1.8e-3)); }},
  {"motor_dead_band", "motor", on_chain, [](P& p, R& r) { return set(chain(p).dead_V, "volts", between(r, 0.1, 0.6)); }},
  {"motor_supply_sag", "motor", on_chain, [](P& p, R& r) { return set(chain(p).source_ohm, "source_ohm", between(r, 0.2, 1.2)); }},
  {"gearbox_coulomb", "gearbox", on_chain, [](P& p, R& r) { return set(chain(p).dry_Nm, "extra_Nm", between(r, 0.02, 0.12)); }, {"gearbox_stribeck"}},
  {"gearbox_asymmetric", "gearbox", on_chain, [](P& p, R& r) {
     const double size = between(r, 0.02, 0.06);
     return set(chain(p).asymmetric_Nm, "extra_Nm", sign(r) * size); }},
  {"gearbox_viscous", "gearbox", on_chain, [](P& p, R& r) { return set(chain(p).viscous, "extra_Nm_s_per_rad", between(r, 0.005, 0.05)); }},
  {"gearbox_stribeck", "gearbox", on_chain, [](P& p, R& r) {
     chain(p).stribeck_Nm = between(r, 0.04, 0.2), chain(p).stribeck_rad_per_s = between(r, 0.2, 1.0);
     return Drawn{{"tustin_Nm", chain(p).stribeck_Nm}, {"tustin_rad_per_s", chain(p).stribeck_rad_per_s}}; }},
  {"gearbox_ageing_stiction", "gearbox", on_chain, [](P& p, R& r) {
     chain(p).stiction_Nm = between(r, 0.1, 0.4), chain(p).stiction_rest_s = scale(r, 0.1, 1), chain(p).stiction_way_rad = scale(r, 0.1, 0.5);
     return Drawn{{"extra_Nm", chain(p).stiction_Nm}, {"rest_s", chain(p).stiction_rest_s}, {"way_rad", chain(p).stiction_way_rad}}; }, {"gearbox_stribeck", "gearbox_coulomb"}},
  {"gearbox_position_dependent", "gearbox", on_chain, [](P& p, R& r) {
     const double size = between(r, 0.02, 0.08), phase = between(r, 0, 6.28);
     chain(p).turn_sine_Nm = size * std::cos(phase), chain(p).turn_cosine_Nm = size * std::sin(phase);
     chain(p).turn_periods = std::uniform_int_distribution(1, 12)(r);
     return Drawn{{"sine_Nm", chain(p).turn_sine_Nm}, {"cosine_Nm", chain(p).turn_cosine_Nm}}; }},
  {"gearbox_load_dependent", "gearbox", on_chain, [](P& p, R& r) { return set(chain(p).load_share, "share", between(r, 0.15, 0.7)); }, {"routing_capstan"}},
  {"gearbox_backlash", "gearbox", on_chain, [](P& p, R& r) { return set(chain(p).backlash_rad, "width_rad", between(r, 0.05, 0.3)); }},
  {"gearbox_inertia", "gearbox", on_chain, [](P& p, R& r) { return set(chain(p).rotor, "relative", between(r, 0.1, 1.0)); }},
  {"gearbox_shaft_compliance", "gearbox", on_chain, [](P& p, R& r) { return set(chain(p).shaft_rad_per_Nm, "rad_per_Nm", between(r, 0.3, 2)); }, {"tendon_kite_line", "tendon_stiffness"}},
  {"spindle_radius", "spindle", on_chain, [](P& p, R& r) { return set(chain(p).radius, "relative", sign(r) * between(r, 0.03, 0.2)); }},
  {"spindle_layers", "spindle", on_chain, [](P& p, R& r) { return set(chain(p).growth_m_per_rad, "growth_m_per_rad", between(r, 3e-5, 2e-4)); }},
  {"spindle_slip", "spindle", on_chain, [](P& p, R& r) { return set(chain(p).slip_per_N, "per_N", scale(r, 3e-5, 3e-4)); }},
  {"tendon_stiffness", "tendon", on_chain, [](P& p, R& r) { return set(chain(p).spring, "relative", sign(r) * between(r, 0.06, 0.4)); }, {"tendon_kite_line", "gearbox_shaft_compliance"}},
  {"tendon_stiffening", "tendon", on_chain, [](P& p, R& r) { return set(chain(p).cubic, "cubic_N_per_m3", scale(r, 3e7, 3e8)); }},
  {"tendon_damping", "tendon", on_chain, [](P& p, R& r) { return set(chain(p).damping, "extra_N_s_per_m", between(r, 40, 250)); }},
  {"tendon_creep", "tendon", on_chain, [](P& p, R& r) {
     chain(p).creep_N_per_m = between(r, 600, 3000), chain(p).creep_s = scale(r, 0.7, 6);
     return Drawn{{"stiffness_N_per_m", chain(p).creep_N_per_m}, {"time_constant_s", chain(p).creep_s}}; }},
  {"tendon_hysteresis", "tendon", on_chain, [](P& p, R& r) {
     chain(p).hysteresis_N = between(r, 0.8, 4), chain(p).hysteresis_m = scale(r, 2e-4, 1e-3);
     return Drawn{{"fibres_N", chain(p).hysteresis_N}}; }},
  {"tendon_length_offset", "tendon", on_chain, [](P& p, R& r) { return set(chain(p).length_offset_m, "length_m", sign(r) * between(r, 1.5e-4, 1e-3)); }, {"sensor_shaft_offset"}},
  {"tendon_kite_line", "tendon", on_chain, [](P& p, R& r) { return set(chain(p).line_m_per_N, "compliance_m_per_N", between(r, 1e-5, 8e-5)); }, {"tendon_stiffness", "gearbox_shaft_compliance"}},
  {"routing_capstan", "routing", on_chain, [](P& p, R& r) { return set(chain(p).capstan, "friction", between(r, 0.08, 0.3)); }, {"gearbox_load_dependent"}},
  {"routing_pulley_radius", "routing", on_chain, [](P& p, R& r) { return set(chain(p).pulley_radius, "relative", sign(r) * between(r, 0.04, 0.2)); }, {"routing_moment_arm"}},
  {"routing_moment_arm", "routing", on_chain, [](P& p, R& r) {
     chain(p).moment_arm = sign(r) * between(r, 0.03, 0.15), chain(p).moment_arm_per_m = sign(r) * between(r, 1, 5);
     return Drawn{{"relative", chain(p).moment_arm}, {"relative_per_m", chain(p).moment_arm_per_m}}; }},
  {"joint_coulomb", "joint", on_joint, [](P& p, R& r) { return set(joint(p).dry_Nm, "extra_Nm", p.strength * between(r, 0.06, 0.25)); }, {"joint_stribeck"}},
  {"joint_viscous", "joint", on_joint, [](P& p, R& r) { return set(joint(p).viscous, "extra_Nm_s_per_rad", p.strength * between(r, 0.05, 0.3)); }},
  {"joint_stribeck", "joint", on_joint, [](P& p, R& r) {
     joint(p).stribeck_Nm = p.strength * between(r, 0.12, 0.4), joint(p).stribeck_rad_per_s = between(r, 0.15, 0.6);
     return Drawn{{"tustin_Nm", joint(p).stribeck_Nm}, {"tustin_rad_per_s", joint(p).stribeck_rad_per_s}}; }},
  {"joint_passive_stiffness", "joint", on_joint, [](P& p, R& r) {
     joint(p).spring = p.strength * between(r, 0.2, 1.5), joint(p).rest_rad = between(r, -0.5, 0.8);
     return Drawn{{"stiffness_Nm_per_rad", joint(p).spring}, {"rest_rad", joint(p).rest_rad}}; }},
  {"joint_early_stop", "joint", on_joint, [](P& p, R& r) {
     const double a = between(r, 0.3, 0.8);
     if (r() & 1) return set(joint(p).min_in_rad, "from_min_rad", a);
     return set(joint(p).max_in_rad, "from_max_rad", a); }},
  {"joint_play", "joint", on_joint, [](P& p, R& r) { return set(joint(p).loose_rad, "width_rad", between(r, 0.01, 0.06)); }},
  {"skeleton_mass", "skeleton", on_body, [](P& p, R& r) { return set(body(p).mass, "relative", sign(r) * between(r, 0.15, 0.5)); }, {"skeleton_payload", "skeleton_com"}},
  {"skeleton_com", "skeleton", on_body, [](P& p, R& r) { return set(body(p).com_m, "outwards_m", sign(r) * between(r, 0.02, 0.05)); }, {"skeleton_payload", "skeleton_mass"}},
  {"skeleton_inertia", "skeleton", on_body, [](P& p, R& r) { return set(body(p).inertia, "relative", between(r, 0.8, 3)); }},
  {"skeleton_payload", "skeleton", on_body, [](P& p, R& r) { return set(body(p).payload_kg, "mass_kg", p.strength * between(r, 0.12, 0.5)); }, {"skeleton_com", "skeleton_mass"}},
  {"skeleton_base_tilt", "skeleton", on_robot, [](P& p, R& r) { return set(p.hidden_effects.tilt_y_rad, "about_y_rad", sign(r) * between(r, 0.06, 0.3)); }},
  {"skeleton_link_flexibility", "skeleton", on_link, [](P& p, R& r) { return set(body(p).bend_rad_per_Nm, "compliance_rad_per_Nm", between(r, 0.05, 0.3) / p.strength); }},
  {"sensor_shaft_offset", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::shaft>(p).offset, "offset_rad", sign(r) * between(r, 0.03, 0.2)); }, {"tendon_length_offset"}},
  {"sensor_current_offset", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::current>(p).offset, "offset_A", sign(r) * between(r, 0.04, 0.3)); }},
  {"sensor_tension_offset", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::tension>(p).offset, "offset_N", between(r, 0.5, 4)); }},
  {"sensor_joint_offset", "sensor", on_joint, [](P& p, R& r) { return set(angle_of(p).offset, "offset_rad", sign(r) * between(r, 0.02, 0.1)); }},
  {"sensor_shaft_gain", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::shaft>(p).gain, "relative", sign(r) * between(r, 0.02, 0.1)); }},
  {"sensor_current_gain", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::current>(p).gain, "relative", sign(r) * between(r, 0.05, 0.25)); }},
  {"sensor_tension_gain", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::tension>(p).gain, "relative", sign(r) * between(r, 0.04, 0.2)); }},
  {"sensor_joint_gain", "sensor", on_joint, [](P& p, R& r) { return set(angle_of(p).gain, "relative", sign(r) * between(r, 0.02, 0.12)); }, {"sensor_joint_eccentricity"}},
  {"sensor_shaft_drift", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::shaft>(p).rate, "rate_rad_per_s", sign(r) * between(r, 0.005, 0.03)); }},
  {"sensor_current_drift", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::current>(p).rate, "rate_A_per_s", sign(r) * between(r, 0.006, 0.04)); }},
  {"sensor_tension_drift", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::tension>(p).rate, "rate_N_per_s", between(r, 0.08, 0.4)); }},
  {"sensor_joint_drift", "sensor", on_joint, [](P& p, R& r) { return set(angle_of(p).rate, "rate_rad_per_s", sign(r) * between(r, 0.002, 0.01)); }},
  {"sensor_shaft_low_pass", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::shaft>(p).lag_s, "time_constant_s", between(r, 0.002, 0.01)); }},
  {"sensor_current_low_pass", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::current>(p).lag_s, "time_constant_s", between(r, 0.005, 0.03)); }},
  {"sensor_tension_low_pass", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::tension>(p).lag_s, "time_constant_s", between(r, 0.008, 0.03)); }},
  {"sensor_joint_low_pass", "sensor", on_joint, [](P& p, R& r) { return set(angle_of(p).lag_s, "time_constant_s", between(r, 0.005, 0.03)); }},
  {"sensor_shaft_eccentricity", "sensor", on_chain, [](P& p, R& r) {
     auto& s = sense_of<&ChainEffects::shaft>(p); const double size = between(r, 0.08, 0.25), phase = between(r, 0, 6.28);
     s.sine_rad = size * std::cos(phase), s.cosine_rad = size * std::sin(phase);
     return Drawn{{"sine_rad", s.sine_rad}, {"cosine_rad", s.cosine_rad}}; }},
  {"sensor_joint_eccentricity", "sensor", on_joint, [](P& p, R& r) {
     auto& s = angle_of(p); const double size = between(r, 0.03, 0.12), phase = between(r, 0, 6.28);
     s.sine_rad = size * std::cos(phase), s.cosine_rad = size * std::sin(phase);
     return Drawn{{"sine_rad", s.sine_rad}, {"cosine_rad", s.cosine_rad}}; }},
  {"sensor_shaft_quantisation", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::shaft>(p).step, "step_rad", scale(r, 1e-3, 0.02)); }},
  {"sensor_current_quantisation", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::current>(p).step, "step_A", scale(r, 0.08, 0.5)); }},
  {"sensor_tension_quantisation", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::tension>(p).step, "step_N", scale(r, 0.5, 3)); }},
  {"sensor_joint_quantisation", "sensor", on_joint, [](P& p, R& r) { return set(angle_of(p).step, "step_rad", scale(r, 4e-3, 0.03)); }},
};

const std::vector<EffectKind> outside{
  {"outside_saturation", "motor", on_chain, [](P& p, R& r) { return set(chain(p).saturation_per_A2, "per_A2", between(r, 0.04, 0.12)); }},
  {"outside_bad_tooth", "gearbox", on_chain, [](P& p, R& r) { return set(chain(p).tooth_Nm, "Nm", between(r, 0.1, 0.4)); }},
  {"outside_oval_spindle", "spindle", on_chain, [](P& p, R& r) { return set(chain(p).eccentricity_m, "m", between(r, 2e-4, 6e-4)); }},
  {"outside_straightening", "tendon", on_chain, [](P& p, R& r) {
     chain(p).slack_m = between(r, 5e-4, 2e-3);
     return set(chain(p).slack_N, "N", between(r, 2, 6)); }},
  {"outside_snag", "routing", on_chain, [](P& p, R& r) {
     chain(p).snag_m = between(r, -0.015, 0.015);
     return set(chain(p).snag_N, "N", between(r, 8, 25)); }},
  {"outside_drag", "joint", on_joint, [](P& p, R& r) { return set(joint(p).drag, "Nm_s2", p.strength * between(r, 0.03, 0.12)); }},
  {"outside_gusts", "joint", on_joint, [](P& p, R& r) { return set(joint(p).random_Nm, "Nm", p.strength * between(r, 0.15, 0.5)); }},
  {"outside_bent_current", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::current>(p).curvature, "per_A", between(r, 0.06, 0.2)); }},
  {"outside_bent_tension", "sensor", on_chain, [](P& p, R& r) { return set(sense_of<&ChainEffects::tension>(p).curvature, "per_N", between(r, 0.004, 0.012)); }},
};
// clang-format on

}  // namespace

std::span<const EffectKind> in_library() { return library; }
std::span<const EffectKind> outside_library() { return outside; }

}  // namespace sim::blind
