#include "sim/rehearsal/rehearse.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "interfaces/recording/columns.hpp"
#include "sim/actuator/design.hpp"
#include "sim/actuator/ecu_units.hpp"
#include "sim/actuator/noise.hpp"
#include "sim/world/virtual_ecus.hpp"

namespace sim::rehearsal {
namespace {

constexpr double tick_s = 0.002;

class Stage {
 public:
  Stage(const erp::Robot& robot, std::uint64_t seed)
      : robot_(robot), world_(robot), ecus_(robot, {.seed = seed}), noise_(seed) {
    for (const erp::Actuator& a : robot.actuators)
      units_.emplace_back(robot.motor_of(a), robot.sensors_of(a), a.spindle);
    last_.resize(robot.actuators.size());
    name_columns();
    give_gains();
    send([&](std::size_t a) { return demand(a); });
  }

  recording::Table play(const Score& score) {
    for (const auto& asked : score) {
      for (std::size_t a = 0; a < last_.size(); ++a)
        if (!std::isnan(asked[a].reference)) last_[a] = asked[a];
      send([&](std::size_t a) { return demand(a); });
      ecus_.tick(world_);
      put(tick_s * static_cast<double>(table_.rows()));
    }
    return std::move(table_);
  }

 private:
  void name_columns() {
    table_.columns.push_back({"time_s", {}});
    for (std::string& name : recording::columns_of(robot_))
      table_.columns.push_back({std::move(name), {}});
  }

  void give_gains() {
    for (const erp::Actuator& a : robot_.actuators) {
      const auto gains = design_parameters(robot_, a, {.stuck_share = 0});
      erp::EcuParameter message;
      for (std::size_t k = 0; k < gains.size(); ++k)
        erp::append(message.values,
                    erp::EcuParameterValue{std::uint8_t(a.ecu), std::uint8_t(a.channel),
                                           std::uint8_t(k), k + 1 == gains.size(), gains[k]});
      ecus_.accept(message);
    }
  }

  /// An actuator that nothing is asked of stays armed, which drives nothing, ready for what comes.
  std::pair<ecu_request, std::int32_t> demand(std::size_t a) const {
    const auto& [mode, reference] = last_[a];
    if (mode == erp::Mode::off) return {ECU_REQUEST_ARM, 0};
    return {EcuUnits::request(mode), units_[a].setpoint(mode, reference)};
  }

  template <class Of>
  void send(Of of) {
    erp::EcuCommand message;
    for (std::size_t a = 0; a < robot_.actuators.size(); ++a) {
      const erp::Actuator& actuator = robot_.actuators[a];
      const auto [request, setpoint] = of(a);
      erp::append(message.channels,
                  erp::EcuChannelCommand{std::uint8_t(actuator.ecu), std::uint8_t(actuator.channel),
                                         std::uint8_t(request), setpoint});
    }
    ecus_.accept(message);
  }

  const erp::EcuChannelSample& said_of(const erp::Actuator& a) const {
    for (const auto& channel : erp::samples(frame_.channels))
      if (channel.ecu == a.ecu && channel.channel == a.channel) return channel;
    throw std::logic_error("an ECU says nothing of \"" + a.name + "\"");
  }

  /// As its sensor says, or as it is where there is none.
  double angle_of(std::size_t joint, const std::string& name) const {
    for (const erp::JointSensor& sensor : robot_.joint_sensors)
      for (const auto& analog : erp::samples(frame_.analogs))
        if (sensor.joint == name && analog.ecu == sensor.ecu && analog.input == sensor.input)
          return 2 * std::numbers::pi / std::exp2(sensor.bits_per_rev) * analog.counts;
    return world_.joints()[joint].position[0];
  }

  void put(double time_s) {
    ecus_.fill(frame_);
    std::size_t column = 0;
    const auto add = [&](double value) {
      if (!std::isfinite(value)) throw std::runtime_error("the rehearsed motion is not finite");
      table_.columns[column++].values.push_back(value);
    };
    add(time_s);
    for (std::size_t a = 0; a < units_.size(); ++a) {
      const auto& said = said_of(robot_.actuators[a]);
      add(static_cast<double>(last_[a].mode)), add(last_[a].reference);
      add(units_[a].voltage_V(said.duty_counts));
      add(said.current_counts * units_[a].current_A_per_count);
      add(units_[a].shaft_rad(said.encoder_counts));
      add(units_[a].tension_N(said.tension_counts));
    }
    const auto joints = robot_.joints();
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (joints[j].type == erp::JointType::revolute) add(angle_of(j, joints[j].name));
      if (joints[j].type == erp::JointType::spherical)
        for (const double q : world_.joints()[j].position)
          add(q + tracking_noise * noise_.normal());
    }
  }

  const erp::Robot& robot_;
  World world_;
  VirtualEcus ecus_;
  std::vector<EcuUnits> units_;
  std::vector<Asked> last_;
  Noise noise_;
  erp::EcuFrame frame_;
  recording::Table table_;
};

}  // namespace

Score score_of(const Excitation& excitation) {
  Score score;
  for (const auto& row : excitation.reference) {
    auto& asked = score.emplace_back();
    for (const double reference : row) asked.push_back({excitation.mode, reference});
  }
  return score;
}

recording::Table rehearse(const erp::Robot& robot, const Score& score, std::uint64_t seed) {
  return Stage(robot, seed).play(score);
}

}  // namespace sim::rehearsal
