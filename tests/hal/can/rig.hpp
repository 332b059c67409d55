#pragma once
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "firmware/core/ecu.h"
#include "interfaces/robot/robot.hpp"
#include "interfaces/topics.hpp"
#include "tests/firmware/core/channel.hpp"

/// Small robots and messages for bus tests.
namespace can_test {

/// `actuators` actuators, two per ECU from address 3 on; joint sensors on inputs 0 and 3 of every
/// second ECU.
inline erp::Robot robot_of(int actuators) {
  erp::Robot robot;
  robot.name = "rig";
  for (int i = 0; i < actuators; ++i) {
    erp::Actuator actuator;
    actuator.name = "muscle_" + std::to_string(i);
    actuator.ecu = 3 + i / 2;
    actuator.channel = i % 2;
    robot.actuators.push_back(actuator);
  }
  for (int ecu = 3; ecu < 3 + (actuators + 1) / 2; ecu += 2)
    for (int input : {0, 3}) {
      erp::JointSensor sensor;
      sensor.joint = "joint_" + std::to_string(ecu) + std::to_string(input);
      sensor.ecu = ecu;
      sensor.input = input;
      robot.joint_sensors.push_back(sensor);
    }
  return robot;
}

/// The robot's channels with simulated converters: readings are a random walk that depends on the
/// seed.
class SimulatedChannels {
 public:
  SimulatedChannels(const erp::Robot& robot, unsigned seed)
      : robot_(robot), channels(robot.actuators.size()), inputs_(channels.size()), random_(seed) {
    for (ecu_channel& channel : channels) ecu_init(&channel), channel_pointers.push_back(&channel);
    erp::assign(frame.robot, robot.name);
  }

  /// One period: new readings, a tick of every channel, the frame for DDS.
  void tick() {
    frame.channels._length = frame.analogs._length = 0;
    ++frame.sequence;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      walk(inputs_[i]);
      ecu_tick(&channels[i], &inputs_[i]);
      const erp::Actuator& actuator = robot_.actuators[i];
      erp::append(frame.channels, sample_of(actuator, channels[i], inputs_[i]));
    }
    for (const erp::JointSensor& sensor : robot_.joint_sensors)
      erp::append(frame.analogs,
                  erp::EcuAnalogSample{std::uint8_t(sensor.ecu), std::uint8_t(sensor.input), true,
                                       between(-8000, 8000)});
  }

  void apply(const erp::EcuCommand& message) {
    for (const auto& command : erp::samples(message.channels))
      ecu_command(&at(command.ecu, command.channel), ecu_request(command.request),
                  command.setpoint);
  }
  void apply(const erp::EcuParameter& message) {
    for (const auto& value : erp::samples(message.values))
      ecu_parameter(&at(value.ecu, value.channel), value.index, value.value, value.commit);
  }

  ecu_channel& at(int ecu, int channel) {
    for (std::size_t i = 0; i < channels.size(); ++i)
      if (robot_.actuators[i].ecu == ecu && robot_.actuators[i].channel == channel)
        return channels[i];
    throw std::out_of_range("no such channel");
  }

 private:
  static erp::EcuChannelSample sample_of(const erp::Actuator& actuator, const ecu_channel& channel,
                                         const ecu_inputs& inputs) {
    return {std::uint8_t(actuator.ecu),
            std::uint8_t(actuator.channel),
            true,
            std::uint8_t(channel.state),
            std::uint8_t(channel.fault),
            std::uint8_t(channel.request),
            channel.setpoint,
            channel.zero_known,
            inputs.encoder_counts + channel.zero_counts,
            channel.duty,
            inputs.current_counts,
            inputs.tension_counts};
  }
  int between(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
  void walk(ecu_inputs& inputs) {
    inputs.encoder_counts += between(-700, 900);  // drifts through many wraps of 16 bits
    inputs.current_counts = std::int16_t(between(-1000, 1000));
    inputs.tension_counts = std::uint16_t(between(0, 4000) / 2);
  }

  const erp::Robot& robot_;

 public:
  std::vector<ecu_channel> channels;
  std::vector<ecu_channel*> channel_pointers;
  erp::EcuFrame frame;

 private:
  std::vector<ecu_inputs> inputs_;
  std::mt19937 random_;
};

inline erp::EcuParameter gains_for(const erp::Robot& robot) {
  erp::EcuParameter message;
  const auto gains = firmware::rig_gains();
  for (const auto& actuator : robot.actuators)
    for (std::uint8_t i = 0; i < ECU_PARAMETER_COUNT; ++i)
      erp::append(message.values,
                  erp::EcuParameterValue{std::uint8_t(actuator.ecu), std::uint8_t(actuator.channel),
                                         i, i + 1 == ECU_PARAMETER_COUNT, gains[i]});
  return message;
}

inline erp::EcuCommand command_for(const erp::Robot& robot, std::uint64_t answers,
                                   std::uint8_t request, std::int32_t setpoint) {
  erp::EcuCommand message;
  message.answers = answers;
  for (const auto& actuator : robot.actuators)
    erp::append(message.channels,
                erp::EcuChannelCommand{std::uint8_t(actuator.ecu), std::uint8_t(actuator.channel),
                                       request, setpoint});
  return message;
}

/// A random command of a plant: mostly valid modes, sometimes any value.
inline erp::EcuCommand any_command(const erp::Robot& robot, std::uint64_t answers,
                                   std::mt19937& random) {
  const auto between = [&](int low, int high) {
    return std::uniform_int_distribution(low, high)(random);
  };
  erp::EcuCommand message = command_for(robot, answers, ECU_REQUEST_ARM, 0);
  std::uint32_t commanded = 0;
  for (auto& command : erp::samples(message.channels)) {
    const int kind = between(0, 19);
    command.request = std::uint8_t(kind < 14    ? 3 + kind % 4
                                   : kind == 14 ? between(0, 255)
                                                : between(0, 2));
    command.setpoint = between(0, 9) ? between(0, 2000) : between(INT32_MIN, INT32_MAX);
    if (between(0, 30) != 0)
      message.channels._buffer[commanded++] = command;  // sometimes no command
  }
  message.channels._length = commanded;
  return message;
}

inline bool same(const erp::EcuChannelSample& a, const erp::EcuChannelSample& b) {
  return a.ecu == b.ecu && a.channel == b.channel && a.fresh == b.fresh && a.state == b.state &&
         a.fault == b.fault && a.request == b.request && a.setpoint == b.setpoint &&
         a.zero_known == b.zero_known && a.encoder_counts == b.encoder_counts &&
         a.duty_counts == b.duty_counts && a.current_counts == b.current_counts &&
         a.tension_counts == b.tension_counts;
}

/// The first difference of two frames, or an empty text.
inline std::string difference(const erp::EcuFrame& a, const erp::EcuFrame& b) {
  if (std::string(a.robot) != b.robot) return "robot";
  if (a.channels._length != b.channels._length) return "number of channels";
  if (a.analogs._length != b.analogs._length) return "number of analog inputs";
  for (std::uint32_t i = 0; i < a.channels._length; ++i) {
    const auto &x = a.channels._buffer[i], &y = b.channels._buffer[i];
    if (!same(x, y))
      return "channel " + std::to_string(i) + " (state " + std::to_string(x.state) + ", " +
             std::to_string(y.state) + ", request " + std::to_string(x.request) + ", " +
             std::to_string(y.request) + ", set-point " + std::to_string(x.setpoint) + ", " +
             std::to_string(y.setpoint) + ")";
  }
  for (std::uint32_t i = 0; i < a.analogs._length; ++i) {
    const auto &x = a.analogs._buffer[i], &y = b.analogs._buffer[i];
    if (x.ecu != y.ecu || x.input != y.input || x.fresh != y.fresh || x.counts != y.counts)
      return "analog input " + std::to_string(i);
  }
  return "";
}

}  // namespace can_test
