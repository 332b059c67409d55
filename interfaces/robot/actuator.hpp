#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "interfaces/robot/sensors.hpp"
#include "interfaces/robot/source.hpp"
#include "interfaces/robot/tendon.hpp"
#include "interfaces/values.hpp"
#include "interfaces/xml/fields.hpp"

/// Motors and actuators of robot.xml.
namespace erp {

struct MotorType {
  static constexpr auto element = "motor_type";
  static constexpr auto description =
      "DC motor with gearbox, eq. 3. Several actuators may use one type.";
  xml::Place place;
  std::string name;
  double resistance_ohm = 0, inductance_H = 0;                           ///< R, L
  double back_emf_V_s_per_rad = 0, torque_Nm_per_A = 0;                  ///< K_E, K_T
  double gear_ratio = 1, gear_efficiency = 1;                            ///< N, η
  double rotor_inertia_kg_m2 = 0, gear_inertia_kg_m2 = 0;                ///< J_M, J_G
  double rotor_viscous_Nm_s_per_rad = 0, gear_viscous_Nm_s_per_rad = 0;  ///< µ_M, µ_G
  double rotor_coulomb_Nm = 0, gear_coulomb_Nm = 0;                      ///< τ_CM, τ_CG
  double supply_V = 12, current_limit_A = 0;
  double continuous_current_A = 0, overload_A2_s = 0;
  std::string source;
  void visit(auto& v) {
    v.required("name", name,
               "Name of the type, unique among motor types; actuators and drives refer to it.");
    v.required("resistance_ohm", resistance_ohm,
               {xml::positive,
                "Resistance R of the cold winding. The ECU also uses it to limit the current."});
    v.required("inductance_H", inductance_H, {xml::positive, "Inductance L of the winding."});
    v.required("back_emf_V_s_per_rad", back_emf_V_s_per_rad,
               {xml::positive, "Back-EMF constant K_E: voltage per speed of the motor shaft."});
    v.required("torque_Nm_per_A", torque_Nm_per_A,
               {xml::positive, "Torque constant K_T, at the motor shaft."});
    v.required(
        "gear_ratio", gear_ratio,
        {xml::positive,
         "Gear ratio N: revolutions of the motor shaft per revolution of the gearbox output."});
    v.required("gear_efficiency", gear_efficiency,
               {xml::Range{0.0, 1.0, true, false},
                "Efficiency η of the gearbox, as a factor on the motor torque while the motor "
                "drives the load; 1/η applies while the load drives the motor."});
    v.required("rotor_inertia_kg_m2", rotor_inertia_kg_m2,
               {xml::positive,
                "Moment of inertia J_M of the rotor, about the motor shaft; acts at the gearbox "
                "output with N²."});
    v("gear_inertia_kg_m2", gear_inertia_kg_m2,
      {xml::at_least_zero, "Moment of inertia J_G of the gearbox, referred to its output."});
    v("rotor_viscous_Nm_s_per_rad", rotor_viscous_Nm_s_per_rad,
      {xml::at_least_zero, "Viscous friction coefficient µ_M at the motor shaft."});
    v("gear_viscous_Nm_s_per_rad", gear_viscous_Nm_s_per_rad,
      {xml::at_least_zero, "Viscous friction coefficient µ_G at the gearbox output."});
    v("rotor_coulomb_Nm", rotor_coulomb_Nm,
      {xml::at_least_zero,
       "Coulomb friction torque τ_CM at the motor shaft, at rest and in motion."});
    v("gear_coulomb_Nm", gear_coulomb_Nm,
      {xml::at_least_zero,
       "Coulomb friction torque τ_CG at the gearbox output, at rest and in motion."});
    v.required("supply_V", supply_V,
               {xml::positive,
                "Supply voltage of the power stage: motor voltage at full duty cycle, limit of "
                "voltage references in both directions."});
    v.required("current_limit_A", current_limit_A,
               {xml::positive,
                "Limit of the magnitude of current references and, by the ECU's motor model, of "
                "the current. The ECU switches the channel off at 1.5 times this value, or at 95 % "
                "of the current sensor's range if that is less."});
    v("continuous_current_A", continuous_current_A,
      {xml::at_least_zero,
       "Permanently allowed current: a larger one increases the integral of overload_A2_s, a "
       "smaller one decreases it."});
    v("overload_A2_s", overload_A2_s,
      {xml::at_least_zero,
       "Limit of ∫ (i² − continuous_current_A²) dt, which never falls below 0; above it the ECU "
       "switches the channel off. 0: no limit."});
    v("source", source, source_description);
  }
};

struct Actuator {
  static constexpr auto element = "actuator";
  static constexpr auto description =
      "Artificial muscle: motor, gearbox, spindle and tendon on one channel of an ECU. The line is "
      "wound up at positive voltage.";
  xml::Place place;
  std::string name, motor, sensors;
  int ecu = 0, channel = 0;
  SafeAction safe_action = SafeAction::relax;
  double max_tension_N = 0;
  double relax_tension_N = 2.0;
  std::optional<double> max_line_speed_m_per_s, max_tension_rate_N_per_s;
  std::string limb;  ///< actuators without one form one group
  std::string source;
  Spindle spindle;
  Tendon tendon;
  std::optional<Rope> rope;
  void visit(auto& v) {
    v.required("name", name,
               "Name, unique among actuators and drives; key of its references and measurements on "
               "the bus and in recordings.");
    v.required("motor", motor, "Name of its motor_type.");
    v.required("sensors", sensors, "Name of its sensor_type.");
    v.required("ecu", ecu, {xml::Range{0, 126}, "CAN address of its ECU."});
    v.required("channel", channel,
               {xml::Range{0, 1}, "Channel of the ECU. Each channel has one actuator."});
    v.required(
        "safe_action", safe_action,
        "Action of the plant when no controller sends references, or an ECU of the limb is silent. "
        "hold: keep the line length; relax: control the tension to relax_tension_N; damp: 0 V.");
    v.required(
        "max_tension_N", max_tension_N,
        {xml::positive,
         "Largest tension reference, at most tension_range_N of its sensors. The ECU switches the "
         "channel off at 1.2 times this value, or at 98 % of that range if that is less."});
    v("relax_tension_N", relax_tension_N,
      {xml::at_least_zero, "Tension of the safe action relax; at most max_tension_N."});
    v("max_line_speed_m_per_s", max_line_speed_m_per_s,
      {xml::positive,
       "Limit on the rate of change of line length references, in both directions. Default: no "
       "limit."});
    v("max_tension_rate_N_per_s", max_tension_rate_N_per_s,
      {xml::positive,
       "Limit on the rate of change of tension references, in both directions. Default: no "
       "limit."});
    v("limb", limb,
      "Name of a group of actuators. When an ECU of the group is silent, all of them take their "
      "safe action, so that none pulls without its antagonist. All actuators without a limb form "
      "one group.");
    v("source", source, source_description);
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
