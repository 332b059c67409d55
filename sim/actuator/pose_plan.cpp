#include "sim/actuator/pose_plan.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "interfaces/values.hpp"
#include "interfaces/xml/words.hpp"

namespace sim {
namespace {

constexpr double rounding_m = 1e-7, rounding_s = 1e-6;  // so that files stay readable

/// Never −0.
double rounded(double x, double step) { return std::round(x / step) / std::round(1 / step) + 0.0; }

/// Which entry of a joint's position a column gives.
struct PoseColumn {
  std::size_t joint, entry;
  const recording::Column* column;
};

std::vector<PoseColumn> pose_columns(const recording::Table& table, const erp::Robot& robot) {
  std::vector<std::string> known;
  std::vector<PoseColumn> found;
  const auto joints = robot.joints();
  const auto look = [&](std::size_t joint, std::size_t entry, const char* signal) {
    known.push_back(joints[joint].name + signal);
    if (const auto* column = table.find(known.back())) found.push_back({joint, entry, column});
  };
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].type == erp::JointType::revolute) look(j, 0, ".angle_rad");
    if (joints[j].type != erp::JointType::spherical) continue;
    look(j, 0, ".qw"), look(j, 1, ".qx"), look(j, 2, ".qy"), look(j, 3, ".qz");
  }
  for (const recording::Column& column : table.columns) {
    const auto signal = recording::signal_of(column.name);
    const bool of_a_joint = signal == "angle_rad" || (signal.size() == 2 && signal[0] == 'q');
    if (of_a_joint && std::ranges::find(known, column.name) == known.end())
      throw std::invalid_argument("column " + xml::quote(column.name) + " belongs to no joint; " +
                                  xml::did_you_mean(column.name, known));
  }
  return found;
}

}  // namespace

std::vector<TimedPose> poses_of(const recording::Table& table, const erp::Robot& robot) {
  const recording::Column* time = table.find("time_s");
  if (!time || time->values.empty()) throw std::invalid_argument("the table has no rows");
  const auto columns = pose_columns(table, robot);
  std::vector<TimedPose> poses;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    TimedPose next{time->values[row], poses.empty() ? starting_pose(robot) : poses.back().pose};
    for (const PoseColumn& c : columns)
      if (const double value = c.column->values[row]; !std::isnan(value))
        next.pose[c.joint][c.entry] = value;
    poses.push_back(next);
  }
  return poses;
}

LengthPlan lengths_through(const erp::Robot& robot, const std::vector<TimedPose>& poses,
                           const PlanOptions& options) {
  LengthPlan plan;
  recording::Table& table = plan.table;
  table.columns.push_back({"time_s", {}});
  for (const erp::Actuator& a : robot.actuators) {
    table.columns.push_back({a.name + ".mode", {}});
    table.columns.push_back({a.name + ".reference", {}});
  }
  const auto add = [&](double time_s, const std::vector<double>& from,
                       const std::vector<double>& to, double way) {
    table.columns[0].values.push_back(rounded(time_s, rounding_s));
    for (std::size_t k = 0; k < to.size(); ++k) {
      const double line_m = from[k] + least_jerk(way) * (to[k] - from[k]);
      table.columns[1 + 2 * k].values.push_back(static_cast<double>(erp::Mode::length));
      table.columns[2 + 2 * k].values.push_back(rounded(line_m, rounding_m));
    }
  };
  std::vector<double> from;
  for (std::size_t p = 0; p < poses.size(); ++p) {
    const bool same = p > 0 && poses[p].pose == poses[p - 1].pose;
    std::vector<double> to = from;
    if (!same) {
      const Holding holding = hold_pose(robot, poses[p].pose, options.holding);
      to = holding.line_m;
      if (holding.unbalanced_Nm > plan.unbalanced_Nm)
        plan.unbalanced_Nm = holding.unbalanced_Nm, plan.at_s = poses[p].time_s;
    }
    const double start_s = p > 0 ? poses[p - 1].time_s : 0, way_s = poses[p].time_s - start_s;
    for (int k = 1; p > 0 && !same && k * options.sample_s < way_s - 1e-9; ++k)
      add(start_s + k * options.sample_s, from, to, k * options.sample_s / way_s);
    add(poses[p].time_s, from.empty() ? to : from, to, 1);
    from = to;
  }
  return plan;
}

}  // namespace sim
