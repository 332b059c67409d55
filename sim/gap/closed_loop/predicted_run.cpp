#include "sim/gap/closed_loop/predicted_run.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "interfaces/recording/columns.hpp"
#include "sim/model/actuator/noise.hpp"

namespace sim::closed_loop {
namespace {

class PredictedRun {
 public:
  PredictedRun(const erp::Robot& robot, std::uint64_t seed, const Ecus& ecus)
      : robot_(robot),
        simulated_(robot, ecus.configured ? *ecus.configured : robot, seed),
        noise_(seed),
        ecu_(ecus.learned) {
    last_.resize(robot.actuators.size());
    const erp::Robot& configured = ecus.configured ? *ecus.configured : robot;
    for (const erp::Actuator& a : configured.actuators)
      loops_.push_back({{erp::Mode::off, a.spindle.radius_m},
                        a.spindle.radius_m,
                        robot.motor_of(a).supply_V,
                        erp::Mode::off,
                        {}});
    table_.columns.push_back({"time_s", {}});
    for (std::string& name : recording::columns_of(robot_))
      table_.columns.push_back({std::move(name), {}});
  }

  recording::Table run(const SetPoints& set_points) {
    for (const auto& row : set_points) {
      previous_ = last_;
      for (std::size_t a = 0; a < last_.size(); ++a)
        if (!std::isnan(row[a].reference)) last_[a] = row[a];
      simulated_.tick(commanded());
      append_row(residuals::tick_s * static_cast<double>(table_.rows()));
    }
    return std::move(table_);
  }

 private:
  /// State of a learned law since the start of its mode.
  struct Loop {
    Regressors regressors;
    double radius_m, supply_V;
    erp::Mode mode;
    std::vector<Eigen::Vector<double, Regressors::count>> history;
  };

  /// Set-points for the firmware: the given ones, or the voltages of learned laws.
  std::vector<SetPoint> commanded() {
    std::vector<SetPoint> commands = last_;
    if (table_.rows() == 0) return commands;  // no measurement before the first tick
    for (std::size_t a = 0; ecu_ && a < commands.size(); ++a)
      for (const bool newest : {true, false}) {
        const SetPoint& command = newest ? last_[a] : previous_[a];
        if (const auto law = ecu_->find({a, command.mode});
            law != ecu_->end() && law->second.newest == newest)
          commands[a] = {erp::Mode::voltage, voltage_of(law->second, command, a)};
      }
    return commands;
  }
  double voltage_of(const LearnedLaw& law, const SetPoint& command, std::size_t a) {
    Loop& loop = loops_[a];
    if (loop.mode != command.mode)
      loop.mode = command.mode, loop.regressors = {loop.mode, loop.radius_m}, loop.history.clear();
    const auto& sample = simulated_.sample_of(a);
    const EcuUnits& units = simulated_.units(a);
    loop.history.push_back(
        loop.regressors.next({command.reference, units.shaft_rad(sample.encoder_counts),
                              sample.current_counts * units.current_A_per_count,
                              units.tension_N(sample.tension_counts)}));
    const std::size_t lag = std::min(law.lag, loop.history.size());
    return std::clamp(law.weights.dot(loop.history[loop.history.size() - lag]), -loop.supply_V,
                      loop.supply_V);
  }

  /// Reading of the joint's sensor, or the true angle of a joint without a sensor.
  double angle_of(std::size_t joint, const std::string& name) const {
    for (const erp::JointSensor& sensor : robot_.joint_sensors)
      for (const auto& analog : erp::samples(simulated_.frame().analogs))
        if (sensor.joint == name && analog.ecu == sensor.ecu && analog.input == sensor.input)
          return 2 * std::numbers::pi / std::exp2(sensor.bits_per_rev) * analog.counts;
    return simulated_.world().joints()[joint].position[0];
  }

  void append_row(double time_s) {
    std::size_t column = 0;
    const auto add = [&](double value) {
      if (!std::isfinite(value)) throw std::runtime_error("the predicted motion is not finite");
      table_.columns[column++].values.push_back(value);
    };
    add(time_s);
    for (std::size_t a = 0; a < last_.size(); ++a) {
      const auto& sample = simulated_.sample_of(a);
      const EcuUnits& units = simulated_.units(a);
      add(static_cast<double>(last_[a].mode)), add(last_[a].reference);
      add(units.voltage_V(sample.duty_counts));
      add(sample.current_counts * units.current_A_per_count);
      add(units.shaft_rad(sample.encoder_counts));
      add(units.tension_N(sample.tension_counts));
    }
    const auto joints = robot_.joints();
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (joints[j].type == erp::JointType::revolute) add(angle_of(j, joints[j].name));
      if (joints[j].type == erp::JointType::spherical)
        for (const double q : simulated_.world().joints()[j].position)
          add(q + tracking_noise * noise_.normal());
    }
  }

  const erp::Robot& robot_;
  SimulatedRobot simulated_;
  std::vector<SetPoint> last_, previous_;
  Noise noise_;
  const LearnedEcu* ecu_;
  std::vector<Loop> loops_;
  recording::Table table_;
};

}  // namespace

SetPoints set_points_of(const Excitation& excitation) {
  SetPoints set_points;
  for (const auto& row : excitation.reference) {
    auto& by_actuator = set_points.emplace_back();
    for (const double reference : row) by_actuator.push_back({excitation.mode, reference});
  }
  return set_points;
}

recording::Table predict_run(const erp::Robot& robot, const SetPoints& set_points,
                             std::uint64_t seed, const Ecus& ecus) {
  return PredictedRun(robot, seed, ecus).run(set_points);
}

}  // namespace sim::closed_loop
