#include "sim/world/virtual_ecus.hpp"

#include <algorithm>
#include <stdexcept>

namespace sim {

namespace {

constexpr double tick_s = 0.002;  // the firmware's period

/// The joint a sensor sits on; only an angle can be read.
int joint_of(const std::vector<erp::Joint>& joints, const erp::JointSensor& sensor) {
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (joints[j].name == sensor.joint && joints[j].type == erp::JointType::revolute)
      return static_cast<int>(j);
  throw std::invalid_argument("joint sensor: \"" + sensor.joint + "\" is no revolute joint");
}

}  // namespace

VirtualEcus::VirtualEcus(const erp::Robot& robot, const VirtualEcuOptions& options)
    : options_(options) {
  if (options.substeps < 1)
    throw std::invalid_argument("substeps must be at least 1, got " +
                                std::to_string(options.substeps));
  std::uint64_t seed = options.seed << 16;
  for (const erp::Actuator& actuator : robot.actuators) {
    const erp::MotorType& motor = robot.motor_of(actuator);
    channels_.push_back({actuator.ecu,
                         actuator.channel,
                         motor.supply_V,
                         ActuatorSensors(motor, robot.sensors_of(actuator), ++seed),
                         {},
                         {}});
    ecu_init(&channels_.back().firmware);
  }
  const std::vector<erp::Joint> joints = robot.joints();
  for (const erp::JointSensor& sensor : robot.joint_sensors)
    analogs_.push_back(
        {sensor.ecu, sensor.input, joint_of(joints, sensor), JointAngleSensor(sensor, ++seed), 0});
  for (Channel& channel : channels_) channel_pointers_.push_back(&channel.firmware);
  voltage_V_.assign(channels_.size(), 0.0);
}

VirtualEcus::Channel* VirtualEcus::find(int ecu, int number) {
  for (Channel& channel : channels_)
    if (channel.ecu == ecu && channel.number == number) return &channel;
  return nullptr;
}

void VirtualEcus::accept(const erp::EcuCommand& command) {
  for (const erp::EcuChannelCommand& c : erp::samples(command.channels))
    if (Channel* channel = find(c.ecu, c.channel))
      ecu_command(&channel->firmware, static_cast<ecu_request>(c.request), c.setpoint);
}

void VirtualEcus::accept(const erp::EcuParameter& parameters) {
  for (const erp::EcuParameterValue& p : erp::samples(parameters.values))
    if (Channel* channel = find(p.ecu, p.channel))
      ecu_parameter(&channel->firmware, p.index, p.value, p.commit);
}

void VirtualEcus::measure(const World& world) {
  const auto actuators = world.actuators();
  for (std::size_t k = 0; k < channels_.size(); ++k)
    channels_[k].counts = channels_[k].sensors.read(actuators[k].shaft_rad, actuators[k].current_A,
                                                    actuators[k].tension_N);
  for (Analog& analog : analogs_)
    analog.counts = analog.sensor.read(world.joints()[analog.joint].position[0]);
  measured_ = true;
}

void VirtualEcus::tick(World& world) {
  if (!measured_) measure(world);
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    const ActuatorCounts& counts = channels_[k].counts;
    const ecu_inputs inputs{counts.encoder, counts.current, counts.tension};
    voltage_V_[k] =
        channels_[k].supply_V * ecu_tick(&channels_[k].firmware, &inputs) / ECU_DUTY_MAX;
  }
  const double dt_s = tick_s / options_.substeps;
  for (int k = 0; k < options_.substeps; ++k) world.step(voltage_V_, dt_s);
  measure(world);
}

void VirtualEcus::fill(erp::EcuFrame& frame) const {
  frame.channels._length = frame.analogs._length = 0;
  for (const Channel& c : channels_)
    erp::append(frame.channels,
                erp::EcuChannelSample{
                    static_cast<std::uint8_t>(c.ecu), static_cast<std::uint8_t>(c.number),
                    measured_, static_cast<std::uint8_t>(c.firmware.state),
                    static_cast<std::uint8_t>(c.firmware.fault),
                    static_cast<std::uint8_t>(c.firmware.request), c.firmware.setpoint,
                    c.counts.encoder, c.firmware.duty, c.counts.current, c.counts.tension});
  for (const Analog& a : analogs_)
    erp::append(frame.analogs,
                erp::EcuAnalogSample{static_cast<std::uint8_t>(a.ecu),
                                     static_cast<std::uint8_t>(a.input), measured_, a.counts});
}

}  // namespace sim
