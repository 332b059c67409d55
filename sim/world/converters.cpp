#include "sim/world/converters.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace sim {
namespace {

constexpr double tick_s = 0.002;  // period of the firmware

template <class Items>
std::size_t index_of(const Items& items, const std::string& name) {
  const auto match =
      std::ranges::find_if(items, [&](const auto& item) { return item.name == name; });
  if (match == items.end())
    throw std::invalid_argument("a sensor on \"" + name + "\", which the robot does not have");
  return static_cast<std::size_t>(match - items.begin());
}

}  // namespace

Converters::Converters(const erp::Robot& robot, std::span<const effects::Placed> acting,
                       int substeps, std::uint64_t& seed)
    : substeps_(substeps) {
  if (substeps < 1)
    throw std::invalid_argument("substeps must be at least 1, got " + std::to_string(substeps));
  add_channels(robot, acting, seed);
  add_analogs(robot, acting, seed);
}

void Converters::add_channels(const erp::Robot& robot, std::span<const effects::Placed> acting,
                              std::uint64_t& seed) {
  for (const erp::Actuator& actuator : robot.actuators) {
    const erp::MotorType& motor = robot.motor_of(actuator);
    const erp::SensorType& sensors = robot.sensors_of(actuator);
    channels_.push_back(
        {actuator.ecu,
         actuator.channel,
         motor.supply_V,
         ActuatorSensors(motor, sensors, ++seed, {acting, actuator.name, effects::Seat::actuator}),
         {sensors.sampling, tick_s / substeps_}});
  }
}

void Converters::add_analogs(const erp::Robot& robot, std::span<const effects::Placed> acting,
                             std::uint64_t& seed) {
  const double step_s = tick_s / substeps_;
  const auto joints = robot.joints();
  for (const erp::JointSensor& s : robot.joint_sensors)
    analogs_.push_back({s.ecu,
                        s.input,
                        index_of(joints, s.joint),
                        JointAngleSensor(s, ++seed, {acting, s.joint, effects::Seat::joint}),
                        {s.sampling, step_s},
                        0});
  for (const erp::Potentiometer& s : robot.potentiometers) {
    const std::size_t actuator = index_of(robot.actuators, s.actuator);
    if (channels_[actuator].ecu == s.ecu) channels_[actuator].wiper = analogs_.size();
    analogs_.push_back(
        {s.ecu, s.input, actuator, PotentiometerSensor(s, ++seed), {s.sampling, step_s}, 0});
  }
}

/// Converters with their own timing sample at each step of the world, the others when the ECU
/// reads.
void Converters::sample(const World& world, bool all) {
  const auto actuators = world.actuators();
  for (std::size_t k = 0; k < channels_.size(); ++k)
    if (Channel& channel = channels_[k]; all || channel.readings.timed())
      channel.readings.offer(world.time_s(), [&] {
        const ActuatorReading& a = actuators[k];
        return channel.sensors.read(a.shaft_rad, a.current_A, a.tension_N, world.time_s());
      });
  for (Analog& analog : analogs_) {
    if (!all && !analog.readings.timed()) continue;
    const auto read = [&]() -> std::int32_t {
      if (auto* angle = std::get_if<JointAngleSensor>(&analog.sensor))
        return angle->read(world.joints()[analog.source], world.time_s());
      return std::get<PotentiometerSensor>(analog.sensor).read(actuators[analog.source].shaft_rad);
    };
    analog.readings.offer(world.time_s(), read);
  }
}

void Converters::measure(const World& world) {
  sample(world, true);
  for (Analog& analog : analogs_) analog.counts = analog.readings.latest(world.time_s()).value;
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    Channel& channel = channels_[k];
    const ActuatorCounts counts = channel.readings.latest(world.time_s()).value;
    ecu_inputs inputs{counts.encoder - channel.start_counts, counts.current, counts.tension};
    if (channel.wiper) inputs.potentiometer_counts = analogs_[*channel.wiper].counts;
    if (faults_)
      faults_->apply_fault(k, world.time_s(), channel.sensors.scale(), channel.inputs, inputs);
    channel.inputs = inputs;
  }
}

void Converters::restart_encoder(std::size_t actuator) {
  Channel& channel = channels_[actuator];
  channel.start_counts += std::exchange(channel.inputs.encoder_counts, 0);
}

void Converters::pass_period(World& world, std::span<const double> voltage_V) {
  pass(world, voltage_V, tick_s);
}

void Converters::pass(World& world, std::span<const double> voltage_V, double duration_s) {
  if (faults_) faults_->apply_fault(world);
  for (int k = 0; k < substeps_; ++k) {
    if (k > 0) sample(world, false);
    world.step(voltage_V, duration_s / substeps_);
  }
  measure(world);
}

}  // namespace sim
