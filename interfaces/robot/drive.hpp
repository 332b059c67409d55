#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "interfaces/xml/fields.hpp"

/// Drives without a tendon, as ordinary machines have them: motor, transmission, slide or shaft.
namespace erp {

/// A carriage that a gearbox shaft moves, by a screw or a rack.
struct Slide {
  static constexpr auto element = "slide";
  xml::Place place;
  double mass_kg = 0;
  double m_per_rad = 0;  ///< way of the carriage for a radian of the gearbox shaft
  double step_m = 0;     ///< of the encoder; 0: not known
  void visit(auto& v) {
    v.required("mass_kg", mass_kg, xml::positive);
    v.required("m_per_rad", m_per_rad, xml::positive);
    v("step_m", step_m, xml::at_least_zero);
  }
};

/// What turns with the gearbox shaft.
struct Shaft {
  static constexpr auto element = "shaft";
  xml::Place place;
  double inertia_kg_m2 = 0;
  double step_rad = 0;  ///< of the encoder; 0: not known
  void visit(auto& v) {
    v.required("inertia_kg_m2", inertia_kg_m2, xml::positive);
    v("step_rad", step_rad, xml::at_least_zero);
  }
};

/// Measures where the load is, behind the transmission.
struct LoadEncoder {
  static constexpr auto element = "load_encoder";
  xml::Place place;
  void visit(auto&) {}
};

/// Measures what the transmission hands to the load.
struct TorqueSensor {
  static constexpr auto element = "torque_sensor";
  xml::Place place;
  double noise_Nm = 0;  ///< rms, on the gearbox shaft; 0: not known
  void visit(auto& v) { v("noise_Nm", noise_Nm, xml::at_least_zero); }
};

/// What a drive's control, in volts, sets: the motor's voltage, its current, or, where only the
/// whole is known, the force.
enum class DriveControl { voltage, current, force };

struct Drive {
  static constexpr auto element = "drive";
  xml::Place place;
  std::string name;
  DriveControl control = DriveControl::voltage;
  double gain = 1;    ///< V, A or N (on a shaft Nm) for a volt of control
  std::string motor;  ///< a motor_type; not for control by force
  std::string source;
  /// Of the transmission, seen at the gearbox shaft; absent: rigid.
  std::optional<double> stiffness_Nm_per_rad;
  double damping_Nm_s_per_rad = 0;
  std::vector<std::variant<Slide, Shaft>> load;  ///< one
  std::vector<std::variant<LoadEncoder, TorqueSensor>> sensors;
  void visit(auto& v) {
    v.required("name", name);
    v.required("control", control);
    v.required("gain", gain, xml::positive);
    v("motor", motor);
    v("source", source);
    v("stiffness_Nm_per_rad", stiffness_Nm_per_rad, xml::positive);
    v("damping_Nm_s_per_rad", damping_Nm_s_per_rad, xml::at_least_zero);
    v.list(load);
    v.list(sensors);
  }
  template <class Sensor>
  const Sensor* find() const {
    for (const auto& sensor : sensors)
      if (const auto* found = std::get_if<Sensor>(&sensor)) return found;
    return nullptr;
  }
};

/// Motor and load are measured apart: there is a chain between them, not one mass.
inline bool has_two_ends(const Drive& drive) { return !drive.sensors.empty(); }

}  // namespace erp

template <>
struct xml::Names<erp::DriveControl> {
  static constexpr auto list = std::to_array<std::pair<const char*, erp::DriveControl>>(
      {{"voltage", erp::DriveControl::voltage},
       {"current", erp::DriveControl::current},
       {"force", erp::DriveControl::force}});
};
