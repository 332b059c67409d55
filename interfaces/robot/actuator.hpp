#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "interfaces/robot/sensors.hpp"
#include "interfaces/values.hpp"
#include "interfaces/xml/fields.hpp"

/// Motors, sensors and tendons of robot.xml.
namespace erp {

/// DC motor with gearbox: the constants of eq. 3. Friction of the motor on its own shaft, of the
/// gearbox on the output shaft.
struct MotorType {
  static constexpr auto element = "motor_type";
  xml::Place place;
  std::string name;
  double resistance_ohm = 0, inductance_H = 0;                           ///< R, L
  double back_emf_V_s_per_rad = 0, torque_Nm_per_A = 0;                  ///< K_E, K_T
  double gear_ratio = 1, gear_efficiency = 1;                            ///< N, η
  double rotor_inertia_kg_m2 = 0, gear_inertia_kg_m2 = 0;                ///< J_M, J_G
  double rotor_viscous_Nm_s_per_rad = 0, gear_viscous_Nm_s_per_rad = 0;  ///< µ_M, µ_G
  double rotor_coulomb_Nm = 0, gear_coulomb_Nm = 0;                      ///< τ_CM, τ_CG
  double supply_V = 12, current_limit_A = 0;
  /// What the winding bears for ever, and ∫ (i² − continuous²) dt beyond which it is switched off;
  /// 0: not judged.
  double continuous_current_A = 0, overload_A2_s = 0;
  std::string source;
  void visit(auto& v) {
    v.required("name", name);
    v.required("resistance_ohm", resistance_ohm, xml::positive);
    v.required("inductance_H", inductance_H, xml::positive);
    v.required("back_emf_V_s_per_rad", back_emf_V_s_per_rad, xml::positive);
    v.required("torque_Nm_per_A", torque_Nm_per_A, xml::positive);
    v.required("gear_ratio", gear_ratio, xml::positive);
    v.required("gear_efficiency", gear_efficiency, xml::Range{0.0, 1.0, true, false});
    v.required("rotor_inertia_kg_m2", rotor_inertia_kg_m2, xml::positive);
    v("gear_inertia_kg_m2", gear_inertia_kg_m2, xml::at_least_zero);
    v("rotor_viscous_Nm_s_per_rad", rotor_viscous_Nm_s_per_rad, xml::at_least_zero);
    v("gear_viscous_Nm_s_per_rad", gear_viscous_Nm_s_per_rad, xml::at_least_zero);
    v("rotor_coulomb_Nm", rotor_coulomb_Nm, xml::at_least_zero);
    v("gear_coulomb_Nm", gear_coulomb_Nm, xml::at_least_zero);
    v.required("supply_V", supply_V, xml::positive);
    v.required("current_limit_A", current_limit_A, xml::positive);
    v("continuous_current_A", continuous_current_A, xml::at_least_zero);
    v("overload_A2_s", overload_A2_s, xml::at_least_zero);
    v("source", source);
  }
};

/// A tendon's end or a point it passes through, fixed to a body.
struct Attach {
  static constexpr auto element = "attach";
  xml::Place place;
  std::string body;
  Vec3 at_m{0, 0, 0};
  void visit(auto& v) { v.required("body", body), v.required("at_m", at_m); }
};

enum class PulleyShape { sphere, cylinder };

/// A sphere, or an endless cylinder, that the tendon wraps around when it is in the way.
struct Pulley {
  static constexpr auto element = "pulley";
  xml::Place place;
  std::string body;
  Vec3 center_m{0, 0, 0};
  double radius_m = 0;
  /// Of a sphere, which side the tendon passes: a direction in the body frame from the centre;
  /// zero: the shorter way.
  Vec3 side{0, 0, 0};
  PulleyShape shape = PulleyShape::sphere;
  /// Given: the tendon runs around it right-handed, from the motor's end on, and its turns are
  /// counted. A cylinder needs one.
  std::optional<Vec3> axis;
  int turns = 0;  ///< whole turns more than needed, at the start
  void visit(auto& v) {
    v.required("body", body);
    v("shape", shape);
    v.required("center_m", center_m);
    v.required("radius_m", radius_m, xml::positive);
    v("side", side);
    v("axis", axis);
    v("turns", turns, xml::Range{0, 20});
  }
};

/// Series elastic tendon, eqs 1 and 2: F = κ Δx + D dΔx/dt, never below zero. The spring may
/// stiffen, F = κ x + κ₃ x³, and the line it hangs on may stretch as well; a tendon without a
/// spring is all line, its stiffness κ.
struct Tendon {
  static constexpr auto element = "tendon";
  xml::Place place;
  double stiffness_N_per_m = 0, damping_N_s_per_m = 0;
  double cubic_N_per_m3 = 0;                     ///< κ₃
  std::optional<double> line_stiffness_N_per_m;  ///< in series with the spring; absent: rigid
  double pretension_N = 0;                       ///< at the initial pose; sets the line length L_K0
  std::string source;
  std::vector<std::variant<Attach, Pulley>> path;  ///< from the motor's end to the distal end
  void visit(auto& v) {
    v.required("stiffness_N_per_m", stiffness_N_per_m, xml::positive);
    v("damping_N_s_per_m", damping_N_s_per_m, xml::at_least_zero);
    v("cubic_N_per_m3", cubic_N_per_m3, xml::at_least_zero);
    v("line_stiffness_N_per_m", line_stiffness_N_per_m, xml::positive);
    v("pretension_N", pretension_N, xml::at_least_zero);
    v("source", source);
    v.list(path);
  }
};

struct Spindle {
  static constexpr auto element = "spindle";
  xml::Place place;
  double radius_m = 0;
  void visit(auto& v) { v.required("radius_m", radius_m, xml::positive); }
};

/// A tendon simulated as a rope of nodes that collides with the bodies' solids and the pulleys
/// (the paper's physical tendon), in place of one that finds its path at once.
struct Rope {
  static constexpr auto element = "rope";
  xml::Place place;
  int nodes = 20;
  double mass_kg = 0, radius_m = 0;
  double friction = 0;  ///< Coulomb's µ, on bones and pulleys
  std::string source;
  void visit(auto& v) {
    v("nodes", nodes, xml::Range{4, 200});
    v.required("mass_kg", mass_kg, xml::positive);
    v.required("radius_m", radius_m, xml::at_least_zero);
    v("friction", friction, xml::Range{0, 2});
    v("source", source);
  }
};

/// One artificial muscle.
struct Actuator {
  static constexpr auto element = "actuator";
  xml::Place place;
  std::string name, motor, sensors;
  int ecu = 0, channel = 0;
  SafeAction safe_action = SafeAction::relax;
  double max_tension_N = 0;
  double relax_tension_N = 2.0;  ///< what `relax` lets the tendon down to
  /// How fast references may change, beyond what motor and controller do; absent: as they come.
  std::optional<double> max_line_speed_m_per_s, max_tension_rate_N_per_s;
  /// When an ECU of it falls silent, all of a limb drop to their safe actions: what pulls on must
  /// not pull alone. Those that name none are one together.
  std::string limb;
  std::string source;
  Spindle spindle;
  Tendon tendon;
  std::optional<Rope> rope;
  void visit(auto& v) {
    v.required("name", name);
    v.required("motor", motor);
    v.required("sensors", sensors);
    v.required("ecu", ecu, xml::Range{0, 126});
    v.required("channel", channel, xml::Range{0, 1});
    v.required("safe_action", safe_action);
    v.required("max_tension_N", max_tension_N, xml::positive);
    v("relax_tension_N", relax_tension_N, xml::at_least_zero);
    v("max_line_speed_m_per_s", max_line_speed_m_per_s, xml::positive);
    v("max_tension_rate_N_per_s", max_tension_rate_N_per_s, xml::positive);
    v("limb", limb);
    v("source", source);
    v.child(spindle);
    v.child(tendon);
    v.optional_child(rope);
  }
};

}  // namespace erp

template <>
struct xml::Names<erp::SafeAction> {
  static constexpr auto list =
      std::to_array<std::pair<const char*, erp::SafeAction>>({{"hold", erp::SafeAction::hold},
                                                              {"relax", erp::SafeAction::relax},
                                                              {"damp", erp::SafeAction::damp}});
};

template <>
struct xml::Names<erp::PulleyShape> {
  static constexpr auto list = std::to_array<std::pair<const char*, erp::PulleyShape>>(
      {{"sphere", erp::PulleyShape::sphere}, {"cylinder", erp::PulleyShape::cylinder}});
};
