#pragma once
#include <vector>

#include "hal/can/gateway.hpp"
#include "hal/can/robot_ecus.hpp"
#include "tests/hal/can/rig.hpp"

namespace can_test {

/// Gateway and ECUs connected without loss or delay.
struct Pair {
  erp::Robot robot;
  SimulatedChannels simulated{robot, 1};
  erp::RobotEcus ecus{robot, simulated.channel_pointers};
  erp::Gateway gateway{robot};

  explicit Pair(int actuators = 5) : Pair(robot_of(actuators)) {}
  explicit Pair(const erp::Robot& robot_model) : robot(robot_model) {}

  int receive(std::span<const erp::CanFrame> frames) {
    int ticks = 0;
    for (const auto& frame : frames) ticks += gateway.receive(frame) == erp::FrameResult::tick;
    return ticks;
  }
  std::vector<erp::CanFrame> report() {
    simulated.tick();
    const auto frames = ecus.report(simulated.frame);
    return {frames.begin(), frames.end()};
  }
  void send(std::span<const erp::CanFrame> frames) {
    for (const auto& frame : frames) ecus.receive(frame);
  }
  void arm() {
    send(gateway.parameters(gains_for(robot)));
    send(gateway.commands(command_for(robot, 0, ECU_REQUEST_ARM, 0)));
  }
  const erp::EcuChannelSample& sample(int i) {
    return erp::samples(gateway.frame().channels)[std::size_t(i)];
  }
};

}  // namespace can_test
