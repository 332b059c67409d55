#include "sim/world/virtual_ecus.hpp"

#include <algorithm>
#include <stdexcept>

#include "sim/effects/library.hpp"

namespace sim {

namespace {

constexpr double tick_s = 0.002;  // the firmware's period

template <class Items>
std::size_t place_of(const Items& items, const std::string& name) {
  const auto found =
      std::ranges::find_if(items, [&](const auto& item) { return item.name == name; });
  if (found == items.end())
    throw std::invalid_argument("a sensor on \"" + name + "\", which the robot does not have");
  return static_cast<std::size_t>(found - items.begin());
}

}  // namespace

VirtualEcus::VirtualEcus(const erp::Robot& nominal, const VirtualEcuOptions& options)
    : options_(options) {
  const auto [robot, acting] = effects::equip(nominal);
  if (options.substeps < 1)
    throw std::invalid_argument("substeps must be at least 1, got " +
                                std::to_string(options.substeps));
  std::uint64_t seed = options.seed << 16;
  add_channels(robot, acting, seed);
  add_analogs(robot, acting, seed);
  bus_ = BusEffects(effects::Acting(acting, nominal.name, effects::Seat::robot), ++seed);
  for (Channel& channel : channels_) channel_pointers_.push_back(&channel.firmware);
  voltage_V_.assign(channels_.size(), 0.0);
}

void VirtualEcus::add_channels(const erp::Robot& robot, Effects acting, std::uint64_t& seed) {
  for (const erp::Actuator& actuator : robot.actuators) {
    const erp::MotorType& motor = robot.motor_of(actuator);
    const erp::SensorType& sensors = robot.sensors_of(actuator);
    channels_.push_back(
        {actuator.ecu,
         actuator.channel,
         motor.supply_V,
         ActuatorSensors(motor, sensors, ++seed, {acting, actuator.name, effects::Seat::actuator}),
         {sensors.sampling, tick_s / options_.substeps},
         {},
         {}});
    ecu_init(&channels_.back().firmware);
  }
}

void VirtualEcus::add_analogs(const erp::Robot& robot, Effects acting, std::uint64_t& seed) {
  const double step_s = tick_s / options_.substeps;
  const auto joints = robot.joints();
  for (const erp::JointSensor& s : robot.joint_sensors)
    analogs_.push_back({s.ecu,
                        s.input,
                        place_of(joints, s.joint),
                        JointAngleSensor(s, ++seed, {acting, s.joint, effects::Seat::joint}),
                        {s.sampling, step_s},
                        0});
  for (const erp::Potentiometer& s : robot.potentiometers) {
    const std::size_t actuator = place_of(robot.actuators, s.actuator);
    if (channels_[actuator].ecu == s.ecu) channels_[actuator].wiper = analogs_.size();
    analogs_.push_back(
        {s.ecu, s.input, actuator, PotentiometerSensor(s, ++seed), {s.sampling, step_s}, 0});
  }
}

VirtualEcus::Channel* VirtualEcus::find(int ecu, int number) {
  for (Channel& channel : channels_)
    if (channel.ecu == ecu && channel.number == number) return &channel;
  return nullptr;
}

void VirtualEcus::accept(const erp::EcuCommand& command) {
  if (bus_.empty()) obey(command);
  else bus_.send(command);
}

void VirtualEcus::obey(const erp::EcuCommand& command) {
  for (const erp::EcuChannelCommand& c : erp::samples(command.channels))
    if (Channel* channel = find(c.ecu, c.channel))
      ecu_command(&channel->firmware, static_cast<ecu_request>(c.request), c.setpoint);
}

void VirtualEcus::accept(const erp::EcuParameter& parameters) {
  for (const erp::EcuParameterValue& p : erp::samples(parameters.values))
    if (Channel* channel = find(p.ecu, p.channel))
      ecu_parameter(&channel->firmware, p.index, p.value, p.commit);
}

/// What is timed looks at each step of the world, the rest when the ECU asks.
void VirtualEcus::look(const World& world, bool all) {
  const auto actuators = world.actuators();
  for (std::size_t k = 0; k < channels_.size(); ++k)
    if (Channel& channel = channels_[k]; all || channel.readings.timed())
      channel.readings.offer(world.time_s(), [&] {
        const ActuatorReading& a = actuators[k];
        return channel.sensors.read(a.shaft_rad, a.current_A, a.tension_N, world.time_s());
      });
  for (Analog& analog : analogs_) {
    if (!all && !analog.readings.timed()) continue;
    const auto see = [&]() -> std::int32_t {
      if (auto* angle = std::get_if<JointAngleSensor>(&analog.sensor))
        return angle->read(world.joints()[analog.source], world.time_s());
      return std::get<PotentiometerSensor>(analog.sensor).read(actuators[analog.source].shaft_rad);
    };
    analog.readings.offer(world.time_s(), see);
  }
}

void VirtualEcus::measure(const World& world) {
  look(world, true);
  for (Channel& channel : channels_) channel.counts = channel.readings.said(world.time_s()).value;
  for (Analog& analog : analogs_) analog.counts = analog.readings.said(world.time_s()).value;
  measured_ = true;
  if (bus_.empty()) return;
  erp::EcuFrame frame;
  report(frame);
  bus_.keep(frame, world.time_s());
}

void VirtualEcus::tick(World& world) {
  if (!measured_) measure(world);
  while (const erp::EcuCommand* command = bus_.arrived(world.time_s())) obey(*command);
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    const ActuatorCounts& counts = channels_[k].counts;
    ecu_inputs inputs{counts.encoder, counts.current, counts.tension};
    if (channels_[k].wiper) inputs.potentiometer_counts = analogs_[*channels_[k].wiper].counts;
    voltage_V_[k] =
        channels_[k].supply_V * ecu_tick(&channels_[k].firmware, &inputs) / ECU_DUTY_MAX;
  }
  const double dt_s = tick_s / options_.substeps;
  for (int k = 0; k < options_.substeps; ++k) {
    if (k > 0) look(world, false);
    world.step(voltage_V_, dt_s);
  }
  measure(world);
}

void VirtualEcus::fill(erp::EcuFrame& frame) const {
  if (bus_.empty() || !measured_) return report(frame);
  const erp::EcuFrame& heard = bus_.heard();
  frame.channels._length = frame.analogs._length = 0;
  for (const auto& channel : erp::samples(heard.channels)) erp::append(frame.channels, channel);
  for (const auto& analog : erp::samples(heard.analogs)) erp::append(frame.analogs, analog);
}

void VirtualEcus::report(erp::EcuFrame& frame) const {
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
