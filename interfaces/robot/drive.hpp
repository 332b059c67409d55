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
  std::vector<std::variant<Slide, Shaft>> load;  ///< one
  void visit(auto& v) {
    v.required("name", name);
    v.required("control", control);
    v.required("gain", gain, xml::positive);
    v("motor", motor);
    v("source", source);
    v.list(load);
  }
};

}  // namespace erp

template <>
struct xml::Names<erp::DriveControl> {
  static constexpr auto list = std::to_array<std::pair<const char*, erp::DriveControl>>(
      {{"voltage", erp::DriveControl::voltage},
       {"current", erp::DriveControl::current},
       {"force", erp::DriveControl::force}});
};
