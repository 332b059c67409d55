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
    std::vector<sim::JointMotion> still;
    for (const auto& joint : names.list()) still.push_back({sim::initial_reading(joint), {}});
    names.write(still, target.message);
    for (const auto& sample : erp::samples(target->joints)) {
      erp::JointStateSample now{};
      erp::assign(now.name, sample.name);
      now.dof = sample.dof;
      std::ranges::copy(sample.position, now.position);
      erp::append(state.message.joints, now);
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
    Eigen::VectorXd all(model.length_m().size());
    for (Eigen::Index a = 0; a < all.size(); ++a) all[a] = command->actuators._buffer[a].reference;
    return all;
  }
  /// −Lᵀ f of a command of forces.
  Eigen::VectorXd torque_of(const std::optional<erp::ActuatorCommand>& command) {
    return -model.jacobian().transpose() * references(command);
  }
  auto step(auto& control, double dt_s = 0.002) { return control.step(frame, dt_s, state, target); }
};
