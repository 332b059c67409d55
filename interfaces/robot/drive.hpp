#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "interfaces/robot/source.hpp"
#include "interfaces/xml/fields.hpp"

/// Drives of machines without tendons: motor, transmission, slide or shaft.
namespace erp {

struct Slide {
  static constexpr auto element = "slide";
  static constexpr auto description =
      "Carriage that the gearbox output moves, by a screw or a rack.";
  xml::Place place;
  double mass_kg = 0;
  double m_per_rad = 0;
  double step_m = 0;  ///< 0: unknown
  void visit(auto& v) {
    v.required("mass_kg", mass_kg, {xml::positive, "Moving mass."});
    v.required("m_per_rad", m_per_rad,
               {xml::positive, "Travel of the carriage per radian of the gearbox output."});
    v("step_m", step_m,
      {xml::at_least_zero,
       "Resolution of the position measurement, as travel of the carriage. Default: unknown; noise "
       "is estimated from the recording."});
  }
};

struct Shaft {
  static constexpr auto element = "shaft";
  static constexpr auto description = "Load that rotates with the gearbox output.";
  xml::Place place;
  double inertia_kg_m2 = 0;
  double step_rad = 0;  ///< 0: unknown
  void visit(auto& v) {
    v.required(
        "inertia_kg_m2", inertia_kg_m2,
        {xml::positive,
         "Moment of inertia about the axis of the gearbox output, without motor and gearbox."});
    v("step_rad", step_rad,
      {xml::at_least_zero,
       "Resolution of the angle measurement, at the gearbox output. Default: unknown; noise is "
       "estimated from the recording."});
  }
};

struct LoadEncoder {
  static constexpr auto element = "load_encoder";
  static constexpr auto description =
      "Sensor of the position of the load, behind the transmission. Requires stiffness_Nm_per_rad.";
  xml::Place place;
  void visit(auto&) {}
};

struct TorqueSensor {
  static constexpr auto element = "torque_sensor";
  static constexpr auto description =
      "Sensor of the torque or force that the transmission applies to the load.";
  xml::Place place;
  double noise_Nm = 0;  ///< 0: unknown
  void visit(auto& v) {
    v("noise_Nm", noise_Nm,
      {xml::at_least_zero,
       "Standard deviation (rms) of the noise, referred to the gearbox output. Default: unknown; "
       "noise is estimated from the recording."});
  }
};

enum class DriveControl { voltage, current, force };

struct Drive {
  static constexpr auto element = "drive";
  static constexpr auto description =
      "Motor that moves a slide or a shaft without a tendon. Only the diagnosis of recordings uses "
      "drives; they are not on the bus and not simulated. Contains exactly one <slide> or <shaft>, "
      "and at most one sensor of each kind.";
  xml::Place place;
  std::string name;
  DriveControl control = DriveControl::voltage;
  double gain = 1;
  std::string motor;  ///< a motor_type; none for control="force"
  std::string source;
  std::optional<double> stiffness_Nm_per_rad;  ///< absent: rigid
  double damping_Nm_s_per_rad = 0;
  std::vector<std::variant<Slide, Shaft>> load;  ///< exactly one
  std::vector<std::variant<LoadEncoder, TorqueSensor>> sensors;
  void visit(auto& v) {
    v.required("name", name,
               "Name, unique among actuators and drives; prefix of its columns in recordings.");
    v.required("control", control,
               "Quantity that the control signal, in volts, sets: motor voltage, motor current, or "
               "the force (torque) on the load if only the total gain is known.");
    v.required("gain", gain,
               {xml::positive,
                "Motor voltage, motor current, or force on a slide (torque on a shaft) per volt of "
                "the control signal, in V, A, N or Nm."});
    v("motor", motor,
      "Name of its motor_type; required unless control is force, and excluded then.");
    v("source", source, source_description);
    v("stiffness_Nm_per_rad", stiffness_Nm_per_rad,
      {xml::positive,
       "Stiffness of the transmission between gearbox and load, referred to the gearbox output. "
       "Default: rigid."});
    v("damping_Nm_s_per_rad", damping_Nm_s_per_rad,
      {xml::at_least_zero,
       "Damping of the transmission, parallel to its stiffness, referred to the gearbox output."});
    v.list(load);
    v.list(sensors);
  }
  /// The sensor of this type; null if the drive has none.
  template <class Sensor>
  const Sensor* find() const {
    for (const auto& sensor : sensors)
      if (const auto* typed = std::get_if<Sensor>(&sensor)) return typed;
    return nullptr;
  }
};

/// Whether the load has its own sensor. Motor and load are then separate stages, not one mass.
inline bool has_load_sensor(const Drive& drive) { return !drive.sensors.empty(); }

}  // namespace erp

template <>
struct xml::Names<erp::DriveControl> {
  static constexpr auto list = std::to_array<std::pair<const char*, erp::DriveControl>>(
      {{"voltage", erp::DriveControl::voltage},
       {"current", erp::DriveControl::current},
       {"force", erp::DriveControl::force}});
};
