#pragma once
#include <catch2/catch.hpp>
#include <optional>
#include <string>

#include "components/joints/joints.hpp"
#include "components/node/run.hpp"
#include "sim/model/actuator/musculoskeletal.hpp"

/// A robot at rest in its starting pose, which is also its target, with all tendons at 5 N.
struct JointBench {
  erp::Robot robot;
  joints::Names names{robot};
  sim::Musculoskeletal model{robot};
  node::Latest<erp::JointState> state;
  node::Latest<erp::JointTarget> target;
  erp::SensorFrame frame;

  explicit JointBench(const std::string& config)
      : robot(erp::read_robot(ERP_SOURCE_DIR "/configs/" + config)) {
    std::vector<sim::JointMotion> targets;
    for (const auto& joint : names.list()) targets.push_back({sim::initial_reading(joint), {}});
    names.write(targets, target.message);
    for (const auto& sample : erp::samples(target->joints)) {
      erp::JointStateSample state_sample{};
      erp::assign(state_sample.name, sample.name);
      state_sample.dof = sample.dof;
      std::ranges::copy(sample.position, state_sample.position);
      erp::append(state.message.joints, state_sample);
    }
    for (const auto& actuator : robot.actuators) {
      erp::ActuatorSample sample{};
      erp::assign(sample.name, actuator.name);
      sample.valid = erp::valid::all;
      sample.tension_N = 5;
      sample.ecu_state = static_cast<std::uint8_t>(erp::EcuState::running);
      erp::append(frame.actuators, sample);
    }
    state.received = target.received = true;
  }
  Eigen::VectorXd gravity_Nm() {
    Eigen::VectorXd torque;
    model.skeleton().gravity_torques(torque);
    return torque;
  }
  /// The references of a command by actuator.
  Eigen::VectorXd references(const std::optional<erp::ActuatorCommand>& command) {
    REQUIRE(command);
    Eigen::VectorXd values(model.length_m().size());
    for (Eigen::Index a = 0; a < values.size(); ++a)
      values[a] = command->actuators._buffer[a].reference;
    return values;
  }
  /// Joint torque −Lᵀ f of a command of tendon forces f, in Nm.
  Eigen::VectorXd torque_of(const std::optional<erp::ActuatorCommand>& command) {
    return -model.jacobian().transpose() * references(command);
  }
  auto step(auto& control, double dt_s = 0.002) { return control.step(frame, dt_s, state, target); }
};
