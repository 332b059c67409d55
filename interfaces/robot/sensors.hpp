#pragma once
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "interfaces/robot/source.hpp"
#include "interfaces/xml/fields.hpp"

/// The sensors of robot.xml. Bits and range define the quantization step; noise is the rms before
/// quantization.
namespace erp {

using xml::Vec3;

/// Sampling rate and latency of a sensor.
struct Sampling {
  double rate_Hz = 0;  ///< 0: samples at each request
  double latency_s = 0;
  void visit(auto& v) {
    v("rate_Hz", rate_Hz,
      {xml::at_least_zero,
       "Sampling rate; an ECU that reads faster gets the last sample again. 0: samples whenever it "
       "is read. At most 500 for an IMU."});
    v("latency_s", latency_s, {xml::Range{0, 1}, "Age of a sample when it becomes available."});
  }
};

struct SensorType {
  static constexpr auto element = "sensor_type";
  static constexpr auto description =
      "Sensors of an actuator, sampled by the converters of its ECU: encoder, motor current and "
      "tendon tension. Several actuators may use one type.";
  xml::Place place;
  std::string name;
  int encoder_counts_per_rev = 2048;
  int current_bits = 12;
  double current_range_A = 8, current_noise_A = 0;  ///< −range … +range
  int tension_bits = 12;
  double tension_range_N = 200, tension_noise_N = 0;  ///< 0 … range
  int tension_zero_counts = 0;                        ///< 0: no live zero
  Sampling sampling;
  std::string source;
  void visit(auto& v) {
    v.required("name", name, "Name of the type, unique among sensor types; actuators refer to it.");
    v.required("encoder_counts_per_rev", encoder_counts_per_rev,
               {xml::Range{1, 1048576},
                "Encoder counts per revolution of the motor shaft, not of the gearbox output; "
                "positive winds up, 0 at the start of the ECU."});
    v.required("current_bits", current_bits,
               {xml::Range{8, 12}, "Resolution of the current converter, sign included."});
    v.required("current_range_A", current_range_A,
               {xml::positive, "Measuring range, from −range to +range; readings saturate there."});
    v("current_noise_A", current_noise_A,
      {xml::at_least_zero,
       "Standard deviation (rms) of the noise before quantization. Only if it is at least one "
       "quantization step, the ECU detects a stuck reading."});
    v.required("tension_bits", tension_bits,
               {xml::Range{8, 12}, "Resolution of the tension converter."});
    v.required("tension_range_N", tension_range_N,
               {xml::positive, "Measuring range, from 0 to range; readings saturate there."});
    v("tension_noise_N", tension_noise_N,
      {xml::at_least_zero,
       "Standard deviation (rms) of the noise before quantization. Only if it is at least one "
       "quantization step, the ECU detects a stuck reading."});
    v("tension_zero_counts", tension_zero_counts,
      {xml::Range{0, 2047},
       "Live zero: counts at zero tension, so that a broken wire, which reads less, is detected. "
       "Default: no live zero."});
    sampling.visit(v);
    v("source", source, source_description);
  }
};

enum class AxisName { x, y, z };

struct JointSensor {
  static constexpr auto element = "joint_sensor";
  static constexpr auto description =
      "Sensor of a joint angle, connected to an analog input of an ECU. On a spherical or free "
      "joint it measures one component of the rotation vector.";
  xml::Place place;
  std::string joint;
  std::optional<AxisName> about;  ///< none for a revolute joint
  int ecu = 0, input = 0;
  int bits_per_rev = 14;
  double noise_rad = 0;
  std::optional<double> min_rad, max_rad;  ///< absent: no limit
  Sampling sampling;
  std::string source;
  void visit(auto& v) {
    v.required("joint", joint, "Name of the joint; not a fixed one.");
    v("about", about,
      "Component of the rotation vector (angle times axis, in the frame of the parent) that it "
      "measures. Required for a spherical or free joint, excluded for a revolute joint.");
    v.required("ecu", ecu, {xml::Range{0, 126}, "CAN address of the ECU that reads it."});
    v.required("input", input,
               {xml::Range{0, 3}, "Analog input of the ECU. Each input has one sensor."});
    v.required(
        "bits_per_rev", bits_per_rev,
        {xml::Range{8, 20},
         "Resolution: the quantization step is a full revolution divided by 2 to this power."});
    v("noise_rad", noise_rad,
      {xml::at_least_zero, "Standard deviation (rms) of the noise before quantization."});
    v("min_rad", min_rad,
      "Smallest angle that it measures; the reading saturates there. Default: no limit.");
    v("max_rad", max_rad,
      "Largest angle that it measures; the reading saturates there. Default: no limit.");
    sampling.visit(v);
    v("source", source, source_description);
  }
};

/// Paper, eq. 5: S_P = (L_K − L_K0)/r + S_P0.
struct Potentiometer {
  static constexpr auto element = "potentiometer";
  static constexpr auto description =
      "Absolute potentiometer on the gearbox output (eq. 5), connected to an analog input of an "
      "ECU. Its reading falls as the line is wound up. On the ECU of its actuator it supervises "
      "the encoder.";
  xml::Place place;
  std::string actuator;
  int ecu = 0, input = 0;
  int bits = 12;
  double range_rad = 0, start_rad = 0;  ///< start: S_P0
  double noise_rad = 0;
  Sampling sampling;
  std::string source;
  void visit(auto& v) {
    v.required("actuator", actuator, "Name of the actuator whose gearbox output it measures.");
    v.required("ecu", ecu, {xml::Range{0, 126}, "CAN address of the ECU that reads it."});
    v.required("input", input,
               {xml::Range{0, 3}, "Analog input of the ECU. Each input has one sensor."});
    v.required("bits", bits, {xml::Range{8, 20}, "Resolution of its converter over range_rad."});
    v.required("range_rad", range_rad,
               {xml::positive, "Measuring range, from 0 to range; readings saturate there."});
    v.required("start_rad", start_rad,
               {xml::at_least_zero,
                "Reading S_P0 at the start, with the line as long as in the starting pose; at most "
                "range_rad."});
    v("noise_rad", noise_rad,
      {xml::at_least_zero, "Standard deviation (rms) of the noise before quantization."});
    sampling.visit(v);
    v("source", source, source_description);
  }
};

struct Imu {
  static constexpr auto element = "imu";
  static constexpr auto description =
      "Inertial measurement unit on a body, with axes parallel to those of the body. It is "
      "connected to the host, not to an ECU.";
  xml::Place place;
  std::string name, body;
  Vec3 at_m{0, 0, 0};
  int bits = 16;
  double acceleration_range_m_per_s2 = 0, acceleration_noise_m_per_s2 = 0;  ///< ± range
  double turning_range_rad_per_s = 0, turning_noise_rad_per_s = 0;          ///< ± range
  Sampling sampling;
  std::string source;
  void visit(auto& v) {
    v.required(
        "name", name,
        "Name, unique among inertial measurement units; key of its measurements on the bus.");
    v.required("body", body, "Name of the body that carries it.");
    v("at_m", at_m, "Position in the frame of the body.");
    v.required("bits", bits, {xml::Range{8, 24}, "Resolution of its converters, sign included."});
    v.required("acceleration_range_m_per_s2", acceleration_range_m_per_s2,
               {xml::positive,
                "Measuring range of the specific force (acceleration minus gravity), from −range "
                "to +range; readings saturate there."});
    v("acceleration_noise_m_per_s2", acceleration_noise_m_per_s2,
      {xml::at_least_zero,
       "Standard deviation (rms) of the noise of each component of the specific force, before "
       "quantization."});
    v.required("turning_range_rad_per_s", turning_range_rad_per_s,
               {xml::positive,
                "Measuring range of the angular velocity, from −range to +range; readings saturate "
                "there."});
    v("turning_noise_rad_per_s", turning_noise_rad_per_s,
      {xml::at_least_zero,
       "Standard deviation (rms) of the noise of each component of the angular velocity, before "
       "quantization."});
    sampling.visit(v);
    v("source", source, source_description);
  }
};

/// Name of a joint sensor on the bus: its joint and its component, such as "shoulder_x".
std::string sample_name(const JointSensor& sensor);

/// An analog input in use.
struct AnalogInput {
  int ecu, input;
  std::string reader;  ///< its sensor, for error messages: sensor of joint "elbow"
};

}  // namespace erp

template <>
struct xml::Names<erp::AxisName> {
  static constexpr auto list = std::to_array<std::pair<const char*, erp::AxisName>>(
      {{"x", erp::AxisName::x}, {"y", erp::AxisName::y}, {"z", erp::AxisName::z}});
};
