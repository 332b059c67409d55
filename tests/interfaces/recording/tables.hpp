#pragma once
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "interfaces/recording/mcap_writer.hpp"
#include "tests/interfaces/recording/cdr_writer.hpp"

/// Writes recordings of a rig with two actuators, without a bus.
namespace test {

constexpr auto* frame_schema =
    "string<=32 robot\nint64 stamp_ns  # [ns]\nuint64 sequence\nerp/ActuatorSample[<=64] "
    "actuators\n"
    "erp/JointSample[<=128] joints\n===\nMSG: erp/ActuatorSample\nstring<=32 name\nuint8 valid\n"
    "uint8 ecu_state\nuint8 ecu_fault\nuint8 mode\nfloat64 reference\nfloat64 voltage_v  # "
    "voltage_V [V]\n"
    "float64 current_a  # current_A [A]\nfloat64 shaft_rad\nfloat64 line_m\nfloat64 tension_n  # "
    "tension_N [N]\n===\n"
    "MSG: erp/JointSample\nstring<=32 name\nuint8 valid\nfloat64 angle_rad\n";
constexpr auto* target_schema =
    "string<=32 robot\nstring<=32 controller\nint64 stamp_ns\nuint64 sequence\nuint64 answers\n"
    "erp/ActuatorReference[<=64] actuators\n===\nMSG: erp/ActuatorReference\nstring<=32 name\n"
    "uint8 mode\nfloat64 reference\n";
constexpr auto* joint_schema =
    "string<=32 robot\nstring<=32 source\nint64 stamp_ns\nuint64 sequence\n"
    "erp/JointStateSample[<=128] joints\n===\nMSG: erp/JointStateSample\nstring<=32 name\n"
    "uint8 dof\nfloat64[4] position\nfloat64[3] velocity_rad_per_s\nfloat64[3] variance_rad2\n";

struct ActuatorRow {
  std::string name;
  std::uint8_t valid = 31, mode = 4;
  double reference = 0, voltage_V = 0, current_A = 0, shaft_rad = 0, line_m = 0, tension_N = 0;
};
struct JointRow {
  std::string name;
  std::uint8_t valid = 1;
  double angle_rad = 0;
};

inline recording::Bytes frame(std::int64_t stamp_ns, std::uint64_t sequence,
                              const std::vector<ActuatorRow>& actuators,
                              const std::vector<JointRow>& joints,
                              const std::string& robot = "rig") {
  CdrWriter cdr;
  cdr.string(robot).put(stamp_ns).put(sequence).put(static_cast<std::uint32_t>(actuators.size()));
  for (const auto& a : actuators) {
    cdr.string(a.name).put(a.valid).put<std::uint8_t>(3).put<std::uint8_t>(0).put(a.mode);
    for (const double x :
         {a.reference, a.voltage_V, a.current_A, a.shaft_rad, a.line_m, a.tension_N})
      cdr.put(x);
  }
  cdr.put(static_cast<std::uint32_t>(joints.size()));
  for (const auto& j : joints) cdr.string(j.name).put(j.valid).put(j.angle_rad);
  return cdr.bytes;
}

inline recording::Bytes target(std::uint64_t answers, const std::string& actuator,
                               std::uint8_t mode, double reference, bool command = false,
                               std::int32_t priority = 0) {
  CdrWriter cdr;
  cdr.string("rig").string("reference").put<std::int64_t>(0).put<std::uint64_t>(0).put(answers);
  if (command) cdr.put(priority);
  cdr.put<std::uint32_t>(1).string(actuator).put(mode).put(reference);
  return cdr.bytes;
}

inline recording::Bytes ball(std::int64_t stamp_ns, const std::string& joint, double qw,
                             const std::string& source = "sim") {
  CdrWriter cdr;
  cdr.string("rig").string(source).put(stamp_ns).put<std::uint64_t>(0).put<std::uint32_t>(1);
  cdr.string(joint).put<std::uint8_t>(3).put(qw);
  for (int i = 0; i < 9; ++i) cdr.put(0.0);
  return cdr.bytes;
}

/// An MCAP file with the channels of a rig.
struct RigFile {
  explicit RigFile(const std::string& path) : writer(path) {
    const auto schema = [&](const char* name, const std::string& text) {
      return writer.add_schema(name, "ros2msg", text);
    };
    frames = writer.add_channel("sensor_frame", "cdr", schema("erp/msg/SensorFrame", frame_schema));
    targets = writer.add_channel("actuator_target", "cdr",
                                 schema("erp/msg/ActuatorTarget", target_schema));
    std::string with_priority = target_schema;
    with_priority.insert(with_priority.find("erp/ActuatorReference"), "int32 priority\n");
    commands = writer.add_channel("actuator_command", "cdr",
                                  schema("erp/msg/ActuatorCommand", with_priority));
    joints = writer.add_channel("joint_state", "cdr", schema("erp/msg/JointState", joint_schema));
  }
  void write(std::uint16_t channel, std::uint64_t log_time_ns, const recording::Bytes& bytes) {
    writer.write(channel, sequence++, log_time_ns, log_time_ns, bytes);
  }
  recording::McapWriter writer;
  std::uint16_t frames, targets, commands, joints;
  std::uint32_t sequence = 0;
};

}  // namespace test
