#pragma once
#include "interfaces/robot/robot.hpp"

/// Common test fixtures: motor set, tendon, path of configuration files.
namespace rigs {

/// The CALIPER motor set, with the friction chosen for hinge_rig.
inline erp::MotorType caliper() {
  erp::MotorType m;
  m.name = "caliper_12V";
  m.resistance_ohm = 0.516, m.inductance_H = 57.3e-6;
  m.back_emf_V_s_per_rad = m.torque_Nm_per_A = 11.5e-3;
  m.gear_ratio = 128, m.gear_efficiency = 0.59;
  m.rotor_inertia_kg_m2 = 14.5e-7, m.gear_inertia_kg_m2 = 0.4e-7;
  m.rotor_viscous_Nm_s_per_rad = 1e-6, m.gear_viscous_Nm_s_per_rad = 5e-4;
  m.rotor_coulomb_Nm = 0.3e-3, m.gear_coulomb_Nm = 5e-3;
  m.supply_V = 12, m.current_limit_A = 4;
  return m;
}

inline erp::MotorType without_friction(erp::MotorType m) {
  m.rotor_viscous_Nm_s_per_rad = m.gear_viscous_Nm_s_per_rad = 0;
  m.rotor_coulomb_Nm = m.gear_coulomb_Nm = 0;
  return m;
}

inline constexpr double spindle_radius_m = 0.0045;

inline erp::Tendon hinge_tendon() {
  erp::Tendon t;
  t.stiffness_N_per_m = 6000, t.damping_N_s_per_m = 20;
  return t;
}

inline std::string config(const std::string& file) {
  return std::string(ERP_SOURCE_DIR) + "/configs/" + file;
}

inline erp::Robot hinge_rig() { return erp::read_robot(config("hinge_rig/robot.xml")); }

}  // namespace rigs
