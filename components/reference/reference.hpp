#pragma once
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "components/reference/signal.hpp"
#include "components/reference/trajectory.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/topics.hpp"

/// Plays a trajectory file or test signals, one message per sensor frame. `reference` sends them to
/// the plant as commands, `target` sends them to controllers as targets.
namespace reference {

struct Params {
  xml::Place place;
  std::string file;
  bool loop = false;
  std::vector<Signal> signals;
  void visit(auto& v) {
    v("file", file,
      "Trajectory (CSV: time_s, and <actuator>.mode, <actuator>.reference), relative to the "
      "config; empty: none.");
    v("loop", loop, "Whether the trajectory is repeated.");
    v.list(signals);
  }
};

template <class OutMessage>
class Reference {
 public:
  using Params = reference::Params;

  /// Throws std::invalid_argument if the robot does not have an actuator.
  Reference(const Params& params, const erp::Robot& robot) : params_(params) {
    if (!params_.file.empty())
      trajectory_ = Trajectory(
          (std::filesystem::path(params_.place.file).parent_path() / params_.file).string());
    for (const auto& column : trajectory_.columns()) check(robot, column.actuator);
    for (const auto& signal : params_.signals) check(robot, signal.actuator);
  }

  OutMessage step(const erp::SensorFrame&, double dt_s) {
    t_s_ += dt_s;
    const double t_s = params_.loop && trajectory_.duration_s() > 0
                           ? std::fmod(t_s_, trajectory_.duration_s())
                           : t_s_;
    OutMessage out;
    for (const auto& column : trajectory_.columns())
      append(out, column.actuator, column.mode_at(t_s), column.at(t_s));
    for (const auto& signal : params_.signals)
      append(out, signal.actuator, signal.mode, signal.at(t_s_));
    return out;
  }

 private:
  static void check(const erp::Robot& robot, const std::string& actuator) {
    for (const auto& candidate : robot.actuators)
      if (candidate.name == actuator) return;
    throw std::invalid_argument("reference: robot \"" + robot.name + "\" has no actuator \"" +
                                actuator + "\"; name one of its actuators");
  }
  static void append(OutMessage& out, const std::string& name, erp::Mode mode, double value) {
    erp::ActuatorReference reference{};
    erp::assign(reference.name, name);
    reference.mode = static_cast<std::uint8_t>(mode);
    reference.reference = value;
    erp::append(out.actuators, reference);
  }

  Params params_;
  Trajectory trajectory_;
  double t_s_ = 0;
};

}  // namespace reference
