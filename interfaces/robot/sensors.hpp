#pragma once
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "interfaces/xml/fields.hpp"

/// The sensors of robot.xml. Bits and range fix the quantum; noise is rms, before quantisation.
namespace erp {

using xml::Vec3;

/// When a sensor looks, and how old what it says is.
struct Sampling {
  double rate_Hz = 0;    ///< 0: whenever it is asked
  double latency_s = 0;  ///< what it says now is what it saw so long ago
  void visit(auto& v) {
    v("rate_Hz", rate_Hz, xml::at_least_zero);
    v("latency_s", latency_s, xml::Range{0, 1});
  }
};

/// What an ECU's converters read for one actuator.
struct SensorType {
  static constexpr auto element = "sensor_type";
  xml::Place place;
  std::string name;
  int encoder_counts_per_rev = 2048;  ///< of the motor shaft
  int current_bits = 12;
  double current_range_A = 8, current_noise_A = 0;  ///< −range … +range
  int tension_bits = 12;
  double tension_range_N = 200, tension_noise_N = 0;  ///< 0 … range
  /// Live zero: what a slack tendon reads, so that a broken wire reads less. 0: none.
  int tension_zero_counts = 0;
  Sampling sampling;
  std::string source;
  void visit(auto& v) {
    v.required("name", name);
    v.required("encoder_counts_per_rev", encoder_counts_per_rev, xml::Range{1, 1048576});
    v.required("current_bits", current_bits, xml::Range{8, 12});
    v.required("current_range_A", current_range_A, xml::positive);
    v("current_noise_A", current_noise_A, xml::at_least_zero);
    v.required("tension_bits", tension_bits, xml::Range{8, 12});
    v.required("tension_range_N", tension_range_N, xml::positive);
    v("tension_noise_N", tension_noise_N, xml::at_least_zero);
    v("tension_zero_counts", tension_zero_counts, xml::Range{0, 2047});
    sampling.visit(v);
    v("source", source);
  }
};

enum class AxisName { x, y, z };

/// A joint angle sensor, read by an ECU's analog input. Of a spherical or free joint it reads one
/// component of the rotation vector (angle times axis, in the parent's frame).
struct JointSensor {
  static constexpr auto element = "joint_sensor";
  xml::Place place;
  std::string joint;
  std::optional<AxisName> about;  ///< which component; not for a revolute joint
  int ecu = 0, input = 0;
  int bits_per_rev = 14;
  double noise_rad = 0;
  std::optional<double> min_rad, max_rad;  ///< beyond, it stays there; absent: no end
  Sampling sampling;
  std::string source;
  void visit(auto& v) {
    v.required("joint", joint);
    v("about", about);
    v.required("ecu", ecu, xml::Range{0, 126});
    v.required("input", input, xml::Range{0, 3});
    v.required("bits_per_rev", bits_per_rev, xml::Range{8, 20});
    v("noise_rad", noise_rad, xml::at_least_zero);
    v("min_rad", min_rad), v("max_rad", max_rad);
    sampling.visit(v);
    v("source", source);
  }
};

/// An absolute potentiometer on the gearbox shaft (paper, eq. 5), read by an ECU's analog input:
/// S_P = (L_K − L_K0)/r + S_P0, which falls as the line is wound up. Beyond 0 … range it stays at
/// its end.
struct Potentiometer {
  static constexpr auto element = "potentiometer";
  xml::Place place;
  std::string actuator;
  int ecu = 0, input = 0;
  int bits = 12;
  double range_rad = 0, start_rad = 0;  ///< S_P0: at the start
  double noise_rad = 0;
  Sampling sampling;
  std::string source;
  void visit(auto& v) {
    v.required("actuator", actuator);
    v.required("ecu", ecu, xml::Range{0, 126});
    v.required("input", input, xml::Range{0, 3});
    v.required("bits", bits, xml::Range{8, 20});
    v.required("range_rad", range_rad, xml::positive);
    v.required("start_rad", start_rad, xml::at_least_zero);
    v("noise_rad", noise_rad, xml::at_least_zero);
    sampling.visit(v);
    v("source", source);
  }
};

/// An inertial unit on a body, its axes the body's. It hangs on the host, not on an ECU.
struct Imu {
  static constexpr auto element = "imu";
  xml::Place place;
  std::string name, body;
  Vec3 at_m{0, 0, 0};
  int bits = 16;
  double acceleration_range_m_per_s2 = 0, acceleration_noise_m_per_s2 = 0;  ///< ± range
  double turning_range_rad_per_s = 0, turning_noise_rad_per_s = 0;          ///< ± range
  Sampling sampling;
  std::string source;
  void visit(auto& v) {
    v.required("name", name), v.required("body", body);
    v("at_m", at_m);
    v.required("bits", bits, xml::Range{8, 24});
    v.required("acceleration_range_m_per_s2", acceleration_range_m_per_s2, xml::positive);
    v("acceleration_noise_m_per_s2", acceleration_noise_m_per_s2, xml::at_least_zero);
    v.required("turning_range_rad_per_s", turning_range_rad_per_s, xml::positive);
    v("turning_noise_rad_per_s", turning_noise_rad_per_s, xml::at_least_zero);
    sampling.visit(v);
    v("source", source);
  }
};

/// What a joint sensor is called on the bus: its joint, and of which component: "shoulder_x".
std::string sample_name(const JointSensor& sensor);

/// An ECU's analog input in use, and for what.
struct AnalogInput {
  int ecu, input;
  std::string reader;  ///< for errors: the sensor of joint "elbow"
};

}  // namespace erp

template <>
struct xml::Names<erp::AxisName> {
  static constexpr auto list = std::to_array<std::pair<const char*, erp::AxisName>>(
      {{"x", erp::AxisName::x}, {"y", erp::AxisName::y}, {"z", erp::AxisName::z}});
};
