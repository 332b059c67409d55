#include "sim/gap/blind/record.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>

#include "interfaces/recording/columns.hpp"
#include "sim/control/gain_design.hpp"
#include "sim/gap/blind/plant.hpp"
#include "sim/model/actuator/ecu_units.hpp"
#include "sim/model/actuator/noise.hpp"
#include "sim/model/actuator/sensors.hpp"

namespace sim::blind {
namespace {

constexpr double period_s = 0.002;             // of the ECU and of the recording
constexpr double gust_time_constant_s = 0.15;  // chosen

/// One sensor: converts a value to a reading.
class SensorModel {
 public:
  SensorModel(const SensorEffects& hidden_effects, double noise, double step, double low,
              double high, double turns = 1)
      : q_(hidden_effects), noise_(noise), step_(step), low_(low), high_(high), turns_(turns) {}

  double read(double value, double time_s, std::mt19937_64& random) {
    const double eccentricity_rad = (ray_rad(turns_ * value) - ray_rad(0)) / turns_;
    double reading = (1 + q_.gain) * (value + eccentricity_rad) + q_.offset + q_.rate * time_s +
                     q_.curvature * value * std::abs(value);
    reading += noise_ * normal_(random);
    if (q_.step > 0) reading = q_.step * std::floor(reading / q_.step + 0.5);
    return std::clamp(step_ * std::floor(reading / step_ + 0.5), low_, high_);
  }

 private:
  /// Angle at which the reading head sees the disc, relative to a centred disc. The centre of the
  /// disc circles the axis; the head is at (1, 0).
  double ray_rad(double angle) const {
    const double s = std::sin(angle), c = std::cos(angle);
    return std::atan2(q_.sine_rad * s + q_.cosine_rad * c, 1 - q_.sine_rad * c + q_.cosine_rad * s);
  }

  SensorEffects q_;
  double noise_, step_, low_, high_, turns_;
  std::normal_distribution<double> normal_;
};

/// An actuator channel's ECU and sensors.
struct Unit {
  ecu_channel ecu{};
  EcuUnits units;
  SensorModel shaft, current, tension;
  double shaft_rad = 0, current_A = 0, tension_N = 0, voltage_V = 0;
};

Unit make_unit(const erp::Robot& robot, const erp::Actuator& actuator, const ChannelEffects& q) {
  const erp::MotorType& motor = robot.motor_of(actuator);
  const erp::SensorType& sensors = robot.sensors_of(actuator);
  const SensorScale s(motor, sensors);
  const double unlimited = 1e9, max_current_A = s.current_A_per_count * s.current_counts_max;
  Unit unit{
      {},
      EcuUnits(motor, sensors, actuator.spindle),
      {q.shaft, 0, s.shaft_rad_per_count, -unlimited, unlimited, motor.gear_ratio},
      {q.current, sensors.current_noise_A, s.current_A_per_count, -max_current_A, max_current_A},
      {q.tension, sensors.tension_noise_N, s.tension_N_per_count, 0,
       s.tension_N_per_count * (s.tension_counts_max - s.tension_zero_counts)}};
  ecu_init(&unit.ecu);
  const auto gains = design_parameters(robot, actuator, {.stuck_speed_fraction = 0});
  for (std::size_t k = 0; k < gains.size(); ++k)
    ecu_parameter(&unit.ecu, static_cast<std::uint8_t>(k), gains[k], k + 1 == gains.size());
  ecu_command(&unit.ecu, ECU_REQUEST_ARM, 0);
  return unit;
}

/// A queue of messages with delays, delivered in order.
template <class Message>
class DelayQueue {
 public:
  void send(double due_s, Message message) {
    queue_.emplace_back(queue_.empty() ? due_s : std::max(due_s, queue_.back().first),
                        std::move(message));
  }
  /// The newest message that arrived since the last call; null: no message arrived.
  const Message* arrived(double now_s) {
    bool has_new = false;
    while (!queue_.empty() && queue_.front().first <= now_s + 1e-9)
      last_ = std::move(queue_.front().second), queue_.pop_front(), has_new = true;
    return has_new ? &last_ : nullptr;
  }
  const Message& last() const { return last_; }

 private:
  std::deque<std::pair<double, Message>> queue_;
  Message last_;
};

class Run {
 public:
  Run(const erp::Robot& nominal, const Case& blind, std::uint64_t seed)
      : nominal_(nominal),
        hidden_effects_(blind.hidden_effects),
        plant_(blind.built.drawn.empty() ? nominal : blind.built.robot, blind.hidden_effects),
        random_(seed) {
    for (std::size_t a = 0; a < nominal.actuators.size(); ++a)
      units_.push_back(make_unit(nominal, nominal.actuators[a], hidden_effects_.channels[a]));
    const auto joints = nominal.joints();
    for (std::size_t j = 0; j < joints.size(); ++j) {
      double noise = 5e-4, step = 2 * std::numbers::pi / (1 << 14);  // chosen: without a sensor
      for (const erp::JointSensor& s : nominal.joint_sensors)
        if (s.joint == joints[j].name)
          noise = s.noise_rad, step = 2 * std::numbers::pi / std::exp2(s.bits_per_rev);
      angles_.emplace_back(hidden_effects_.joints[j].angle, noise, step, -10, 10);
      types_.push_back(joints[j].type);
    }
    name_columns();
  }

  recording::Table run(const Excitation& excitation) {
    measure();
    for (std::size_t row = 0; row < excitation.reference.size(); ++row) {
      const double now_s = static_cast<double>(row) * period_s;
      const double delay =
          hidden_effects_.command_delay_s + hidden_effects_.jitter_s * uniform_(random_);
      if (!(uniform_(random_) < hidden_effects_.loss))
        commands_.send(now_s + delay, excitation.reference[row]);
      if (const auto* command = commands_.arrived(now_s)) received_ = *command;
      apply_command(excitation.mode);
      step();
      frames_.send(now_s + period_s + hidden_effects_.frame_delay_s, readings());
      frames_.arrived(now_s + period_s);
      append_row(now_s, excitation, row);
    }
    return table_;
  }

 private:
  void name_columns() {
    table_.columns.push_back({"time_s", {}});
    for (std::string& name : recording::columns_of(nominal_))
      table_.columns.push_back({std::move(name), {}});
  }
  void apply_command(erp::Mode mode) {
    for (std::size_t a = 0; a < units_.size(); ++a)
      if (received_.empty()) ecu_command(&units_[a].ecu, ECU_REQUEST_ARM, 0);
      else
        ecu_command(&units_[a].ecu, EcuUnits::request(mode),
                    units_[a].units.setpoint(mode, received_[a]));
  }
  void measure() {
    const double now_s = plant_.time_s();
    for (std::size_t a = 0; a < units_.size(); ++a) {
      Unit& u = units_[a];
      u.shaft_rad = u.shaft.read(plant_.shaft_rad(a), now_s, random_);
      u.current_A = u.current.read(plant_.current_A(a), now_s, random_);
      u.tension_N = u.tension.read(plant_.tension_N(a), now_s, random_);
    }
  }
  void step() {
    std::vector<double> previous_volts, volts;
    for (Unit& u : units_) {
      previous_volts.push_back(u.voltage_V);
      const ecu_inputs inputs{
          static_cast<std::int32_t>(std::lround(u.shaft_rad / u.units.shaft_rad_per_count)),
          static_cast<std::int16_t>(std::lround(u.current_A / u.units.current_A_per_count)),
          static_cast<std::uint16_t>(u.units.tension_zero_counts +
                                     std::lround(u.tension_N / u.units.tension_N_per_count))};
      u.voltage_V = u.units.voltage_V(ecu_tick(&u.ecu, &inputs));
      volts.push_back(u.voltage_V);
    }
    // Ornstein–Uhlenbeck process of unit variance: g += −g Δt/T + √(2 Δt/T) N(0, 1)
    constexpr double gust_relative_step = period_s / gust_time_constant_s;
    gust_ += gust_relative_step * -gust_ + std::sqrt(2 * gust_relative_step) * normal_(random_);
    drive(previous_volts, volts);
    measure();
  }
  /// Advances one period. A delayed driver applies the previous voltage until its delay has passed.
  void drive(std::vector<double> volts, const std::vector<double>& new_volts) {
    double elapsed_s = 0;
    const auto advance_to = [&](double end_s) {
      if (end_s > elapsed_s && !plant_.run(volts, end_s - elapsed_s, gust_))
        throw NotFinite("the motion of a blind case is not finite: use other seeds");
      elapsed_s = std::max(elapsed_s, end_s);
    };
    std::vector<std::size_t> order(new_volts.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    const auto delay_s = [&](std::size_t a) { return hidden_effects_.channels[a].driver_delay_s; };
    std::ranges::sort(order, {}, delay_s);
    for (const std::size_t a : order) advance_to(delay_s(a)), volts[a] = new_volts[a];
    advance_to(period_s);
  }
  std::vector<double> readings() {
    std::vector<double> values;
    for (const Unit& u : units_)
      values.insert(values.end(), {u.voltage_V, u.current_A, u.shaft_rad, u.tension_N});
    for (std::size_t j = 0; j < types_.size(); ++j) {
      if (types_[j] == erp::JointType::revolute)
        values.push_back(angles_[j].read(plant_.angle_rad(j), plant_.time_s(), random_));
      if (types_[j] == erp::JointType::spherical)
        for (const double q : plant_.quaternion(j))
          values.push_back(q + tracking_noise * normal_(random_));
    }
    return values;
  }
  void append_row(double now_s, const Excitation& excitation, std::size_t row) {
    const auto& frame = frames_.last();
    if (frame.empty()) return;
    std::size_t column = 0, next = 0;
    const auto add = [&](double value) { table_.columns[column++].values.push_back(value); };
    add(now_s);
    for (std::size_t a = 0; a < units_.size(); ++a) {
      add(static_cast<double>(excitation.mode)), add(excitation.reference[row][a]);
      for (int k = 0; k < 4; ++k) add(frame[next++]);
    }
    while (next < frame.size()) add(frame[next++]);
  }

  const erp::Robot& nominal_;
  HiddenEffects hidden_effects_;
  Plant plant_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_{0, 1};
  std::vector<Unit> units_;
  std::vector<SensorModel> angles_;
  std::vector<erp::JointType> types_;
  DelayQueue<std::vector<double>> commands_, frames_;
  std::vector<double> received_;
  double gust_ = 0;
  recording::Table table_;
};

}  // namespace

recording::Table record(const erp::Robot& nominal, const Case& blind, const Excitation& excitation,
                        std::uint64_t seed) {
  return Run(nominal, blind, seed).run(excitation);
}

}  // namespace sim::blind
