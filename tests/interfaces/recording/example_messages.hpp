#pragma once
#include <cstring>

#include "interfaces/topics.hpp"

/// One example message of every topic. All numbers in a message differ: a number identifies its
/// field.
namespace test {

template <class M>
void fill_header(M& m, std::uint64_t n) {
  erp::assign(m.robot, "rig");
  m.stamp_ns = 1'700'000'000'000'000'000 + static_cast<std::int64_t>(n);
  m.sequence = n;
}

template <class M>
M references(std::uint64_t n) {
  M m;
  fill_header(m, n);
  erp::assign(m.controller, "reference");
  m.answers = n + 40;
  erp::ActuatorReference r{};
  erp::assign(r.name, "flexor"), r.mode = 4, r.reference = 0.1 + static_cast<double>(n);
  erp::append(m.actuators, r);
  erp::assign(r.name, "extensor"), r.mode = 2, r.reference = -1e-9;
  erp::append(m.actuators, r);
  return m;
}

inline void fill(erp::ActuatorTarget& m, std::uint64_t n) {
  m = references<erp::ActuatorTarget>(n);
}
inline void fill(erp::ActuatorCommand& m, std::uint64_t n) {
  m = references<erp::ActuatorCommand>(n);
  m.priority = -3;
}
inline void fill(erp::SensorFrame& m, std::uint64_t n) {
  fill_header(m, n);
  const auto x = static_cast<double>(n);
  erp::ActuatorSample a{};
  erp::assign(a.name, "flexor");
  a.valid = 31, a.ecu_state = 3, a.ecu_fault = 2, a.mode = 4, a.reference = 40.5 + x;
  a.voltage_V = 1.25, a.current_A = -0.3, a.shaft_rad = 1.0 / 3, a.line_m = -2e-3,
  a.tension_N = 39.9 + x, a.potentiometer_rad = 2.5;
  erp::append(m.actuators, a);
  erp::assign(a.name, "a_name_of_thirty_two_characters_");
  a.valid = 16, a.mode = 0, a.tension_N = 5e-324;
  erp::append(m.actuators, a);
  erp::JointSample j{};
  erp::assign(j.name, "elbow"), j.valid = 1, j.angle_rad = 0.7;
  erp::append(m.joints, j);
}
inline void fill(erp::EcuCommand& m, std::uint64_t n) {
  fill_header(m, n);
  m.answers = 11;
  erp::append(m.channels, erp::EcuChannelCommand{1, 2, 3, -400000});
}
inline void fill(erp::EcuFrame& m, std::uint64_t n) {
  fill_header(m, n);
  erp::append(m.channels, erp::EcuChannelSample{1, 0, true, 3, 4, 5, -600000, true, 700000, -1023,
                                                -2048, 4095, 6, 201});
  erp::append(m.channels, erp::EcuChannelSample{2, 1, false, 1, 0, 2, 9, false, 8, 7, 6, 5});
  erp::append(m.analogs, erp::EcuAnalogSample{1, 3, true, -8191});
}
inline void fill(erp::EcuParameter& m, std::uint64_t n) {
  fill_header(m, n);
  for (int i = 0; i < 200; ++i)
    erp::append(m.values, erp::EcuParameterValue{1, 0, static_cast<std::uint8_t>(i), i % 2 == 0,
                                                 0.125f * static_cast<float>(i)});
}
inline void fill(erp::GainCommand& m, std::uint64_t n) {
  fill_header(m, n);
  erp::assign(m.controller, "tuner"), m.answers = 4, m.priority = 9;
  erp::GainValue g{};
  erp::assign(g.name, "flexor"), erp::assign(g.parameter, "length_gain_V_per_rad"), g.value = 12.5;
  erp::append(m.gains, g);
}
inline void fill(erp::JointState& m, std::uint64_t n) {
  fill_header(m, n);
  erp::assign(m.source, "sim");
  erp::JointStateSample j{};
  erp::assign(j.name, "shoulder"), j.dof = 3;
  for (int i = 0; i < 4; ++i) j.position[i] = 0.5 + i;
  for (int i = 0; i < 3; ++i) j.velocity_rad_per_s[i] = -i, j.variance_rad2[i] = 1e-6 * i;
  erp::append(m.joints, j);
  erp::assign(j.name, "elbow"), j.dof = 1;
  erp::append(m.joints, j);
}
inline void fill(erp::JointTarget& m, std::uint64_t n) {
  fill_header(m, n);
  erp::assign(m.controller, "joint_target"), m.answers = n + 12;
  erp::JointTargetSample j{};
  erp::assign(j.name, "shoulder"), j.dof = 3;
  for (int i = 0; i < 4; ++i) j.position[i] = 0.125 + i;
  for (int i = 0; i < 3; ++i)
    j.velocity_rad_per_s[i] = 2 * i, j.acceleration_rad_per_s2[i] = -9 * i;
  erp::append(m.joints, j);
}
inline void fill(erp::BodyPose& m, std::uint64_t n) {
  fill_header(m, n);
  erp::assign(m.source, "motion_capture");
  erp::BodyPoseSample b{};
  erp::assign(b.name, "forearm");
  for (int i = 0; i < 3; ++i) b.position_m[i] = 0.25 * i;
  for (int i = 0; i < 4; ++i) b.orientation_wxyz[i] = i == 0;
  erp::append(m.bodies, b);
}
inline void fill(erp::ImagePoint& m, std::uint64_t n) {
  fill_header(m, n);
  erp::assign(m.source, "eye");
  erp::ImagePointSample p{};
  erp::assign(p.camera, "below"), p.u_px = 319.5, p.v_px = 0.25, p.area_px = 153;
  erp::append(m.points, p);
}
inline void fill(erp::ImuFrame& m, std::uint64_t n) {
  fill_header(m, n);
  erp::assign(m.source, "sim");
  erp::ImuSample i{};
  erp::assign(i.name, "head");
  for (int k = 0; k < 3; ++k) i.acceleration_m_per_s2[k] = 9.81 * k, i.turning_rad_per_s[k] = -k;
  erp::append(m.imus, i);
}
inline void fill(erp::ActuatorOwner& m, std::uint64_t n) {
  fill_header(m, n);
  erp::ActuatorOwnerSample o{};
  erp::assign(o.name, "flexor"), erp::assign(o.owner, "force_control"), o.priority = 7;
  o.safe_action = 2, o.limited = 3, o.refused = 4'000'000'000;
  erp::assign(o.reason, "over 150 N, \"twice\"");
  erp::append(m.actuators, o);
}
inline void fill(erp::ComponentState& m, std::uint64_t n) {
  fill_header(m, n);
  erp::assign(m.component, "plant"), erp::assign(m.note, "fine");
  m.pid = 4711, m.lifecycle = 2, m.peers = 3, m.links = 8, m.steps = 1'000'000'000'000,
  m.rate_Hz = 499.5;
  m.overruns = 1, m.missed = 2;
  for (std::uint32_t i = 0; i < 24; ++i) m.age_bins[i] = i, m.jitter_bins[i] = 100 + i;
}
inline void fill(erp::LifecycleCommand& m, std::uint64_t n) {
  fill_header(m, n);
  erp::assign(m.component, "plant"), m.target = 4;
}
inline void fill(erp::Clock& m, std::uint64_t n) {
  fill_header(m, n);
  m.real_time_factor = 7.5, m.finished = true;
}
inline void fill(erp::Event& m, std::uint64_t n) {
  fill_header(m, n);
  erp::assign(m.component, "plant"), m.severity = 2, erp::assign(m.subject, "flexor");
  erp::assign(m.code, "stale_command"), erp::assign(m.text, "no command for 22 ms");
}

/// Calls `use(message, topic, descriptor)` with an example of every topic on the bus.
template <class Callback>
void each_example(std::uint64_t n, Callback&& callback) {
  const auto call = [&]<class M>(M m) {
    fill(m, n);
    callback(m, std::string(erp::Topic<M>::name), *erp::Topic<M>::type);
  };
  call(erp::ActuatorCommand()), call(erp::ActuatorTarget()), call(erp::SensorFrame());
  call(erp::EcuCommand()), call(erp::EcuFrame()), call(erp::EcuParameter()),
      call(erp::GainCommand());
  call(erp::JointState()), call(erp::JointTarget()), call(erp::BodyPose()), call(erp::ImuFrame());
  call(erp::ImagePoint()), call(erp::ActuatorOwner());
  call(erp::ComponentState()), call(erp::LifecycleCommand()), call(erp::Clock()),
      call(erp::Event());
}

}  // namespace test
