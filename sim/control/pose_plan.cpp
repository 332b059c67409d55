#include "sim/control/pose_plan.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "interfaces/values.hpp"
#include "interfaces/xml/values.hpp"
#include "interfaces/xml/words.hpp"

namespace sim {
namespace {

constexpr double norm_tolerance = 1e-3;  // chosen: tolerance of a quaternion's norm
constexpr double range_tolerance_rad =
    1e-2;  // chosen: recordings exceed the stops slightly because of noise
constexpr double same_time_s = 1e-9;  // chosen: tolerance for rounded times
constexpr double rounding_m = 1e-7, rounding_s = 1e-6, rounding_rad = 1e-6;  // for readable files

/// The multiple of `step` nearest to x; adding 0 avoids −0.
double rounded(double x, double step) { return std::round(x / step) / std::round(1 / step) + 0.0; }

/// The columns of a joint's position, in the order of its entries.
std::vector<const char*> signals_of(const erp::Joint& joint) {
  if (joint.type == erp::JointType::revolute) return {".angle_rad"};
  if (joint.type == erp::JointType::spherical) return {".qw", ".qx", ".qy", ".qz"};
  return {};
}

/// The entry of a joint's position that a column contains.
struct PoseColumn {
  std::size_t joint, entry;
  const recording::Column* column;
};

/// Columns of recordings that are not joint positions: sensors of ball joints, rotation of free
/// bodies.
bool is_ignored_column(const std::string& column, const erp::Robot& robot) {
  for (const erp::JointSensor& sensor : robot.joint_sensors)
    if (sensor.about && column == erp::sample_name(sensor) + ".angle_rad") return true;
  for (const erp::Joint& joint : robot.joints())
    if (joint.type == erp::JointType::free && column.starts_with(joint.name + ".q")) return true;
  return false;
}

/// Rejects a position that is invalid for its joint.
void check_pose(const TimedPose& timed, std::size_t row, const std::vector<erp::Joint>& joints) {
  const auto reject = [&](const erp::Joint& joint, const std::string& what) {
    throw std::invalid_argument("row " + std::to_string(row + 1) + ", joint " +
                                xml::quote(joint.name) + ": " + what);
  };
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const erp::Joint& joint = joints[j];
    const auto& p = timed.pose[j];
    const double norm = std::hypot(std::hypot(p[0], p[1]), std::hypot(p[2], p[3]));
    if (joint.type == erp::JointType::spherical && !(std::abs(norm - 1) < norm_tolerance))
      reject(joint, "its quaternion has norm " + xml::write_number(norm) + "; normalise it");
    if (joint.type != erp::JointType::revolute) continue;
    if (!(p[0] >= joint.min_rad - range_tolerance_rad &&
          p[0] <= joint.max_rad + range_tolerance_rad))
      reject(joint, xml::write_number(p[0]) + " rad is out of its range, " +
                        xml::write_number(joint.min_rad) + " … " +
                        xml::write_number(joint.max_rad));
  }
}

std::vector<PoseColumn> pose_columns(const recording::Table& table, const erp::Robot& robot) {
  std::vector<std::string> joint_columns;
  std::vector<PoseColumn> columns;
  const auto joints = robot.joints();
  for (std::size_t j = 0; j < joints.size(); ++j)
    for (std::size_t entry = 0; const char* signal : signals_of(joints[j])) {
      joint_columns.push_back(joints[j].name + signal);
      if (const auto* column = table.find(joint_columns.back()))
        columns.push_back({j, entry, column});
      ++entry;
    }
  for (const recording::Column& column : table.columns) {
    const auto signal = recording::signal_of(column.name);
    const bool of_a_joint = signal == "angle_rad" || (signal.size() == 2 && signal[0] == 'q');
    if (of_a_joint && std::ranges::find(joint_columns, column.name) == joint_columns.end() &&
        !is_ignored_column(column.name, robot))
      throw std::invalid_argument("column " + xml::quote(column.name) + " belongs to no joint; " +
                                  xml::did_you_mean(column.name, joint_columns));
  }
  return columns;
}

}  // namespace

std::vector<TimedPose> poses_of(const recording::Table& table, const erp::Robot& robot) {
  const recording::Column* time = table.find("time_s");
  if (!time || time->values.empty()) throw std::invalid_argument("the table has no rows");
  const auto columns = pose_columns(table, robot);
  const auto joints = robot.joints();
  std::vector<TimedPose> poses;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    TimedPose timed_pose{time->values[row],
                         poses.empty() ? starting_pose(robot) : poses.back().pose};
    for (const PoseColumn& c : columns)
      if (const double value = c.column->values[row]; !std::isnan(value))
        timed_pose.pose[c.joint][c.entry] = value;
    check_pose(timed_pose, row, joints);
    poses.push_back(timed_pose);
  }
  return poses;
}

recording::Table table_of(const std::vector<TimedPose>& poses, const erp::Robot& robot) {
  recording::Table table{{{"time_s", {}}}};
  for (const TimedPose& timed : poses)
    table.columns[0].values.push_back(rounded(timed.time_s, rounding_s));
  const auto joints = robot.joints();
  for (std::size_t j = 0; j < joints.size(); ++j)
    for (std::size_t entry = 0; const char* signal : signals_of(joints[j])) {
      auto& column = table.columns.emplace_back(joints[j].name + signal, std::vector<double>{});
      for (const TimedPose& timed : poses)
        column.values.push_back(rounded(timed.pose[j][entry], rounding_rad));
      ++entry;
    }
  return table;
}

namespace {

class Planner {
 public:
  Planner(const erp::Robot& robot, const PlanOptions& options)
      : holder_(robot), joints_(robot.joints()), options_(options) {
    plan_.table.columns.push_back({"time_s", {}});
    for (const erp::Actuator& a : robot.actuators) {
      plan_.table.columns.push_back({a.name + ".mode", {}});
      plan_.table.columns.push_back({a.name + ".reference", {}});
    }
  }

  void hold(double time_s, const Pose& pose) {
    const Holding holding = holder_.hold(pose, options_.holding);
    if (!(holding.unbalanced_Nm <= plan_.unbalanced_Nm))
      plan_.unbalanced_Nm = holding.unbalanced_Nm, plan_.at_s = time_s;
    add(time_s, holding.line_m);
  }
  /// Adds rows for both poses and for the samples between them.
  void move(const TimedPose& from, const TimedPose& to) {
    const JointPath path(joints_, {from, to});
    std::vector<JointMotion> motions;
    for (int k = 1; from.time_s + k * options_.sample_s < to.time_s - same_time_s; ++k) {
      const double time_s = from.time_s + k * options_.sample_s;
      path.at(time_s, motions);
      Pose pose;
      for (const JointMotion& motion : motions) pose.push_back(motion.now.position);
      hold(time_s, pose);
    }
    hold(to.time_s, to.pose);
  }
  void rest(double time_s) { add(time_s, last_line_m_); }
  LengthPlan plan() { return std::move(plan_); }

 private:
  void add(double time_s, const std::vector<double>& line_m) {
    auto& columns = plan_.table.columns;
    columns[0].values.push_back(rounded(time_s, rounding_s));
    for (std::size_t k = 0; k < line_m.size(); ++k) {
      columns[1 + 2 * k].values.push_back(static_cast<double>(erp::Mode::length));
      columns[2 + 2 * k].values.push_back(rounded(line_m[k], rounding_m));
    }
    last_line_m_ = line_m;
  }

  PoseHolder holder_;
  std::vector<erp::Joint> joints_;
  PlanOptions options_;
  LengthPlan plan_;
  std::vector<double> last_line_m_;
};

}  // namespace

LengthPlan lengths_through(const erp::Robot& robot, const std::vector<TimedPose>& poses,
                           const PlanOptions& options) {
  Planner planner(robot, options);
  for (std::size_t p = 0; p < poses.size(); ++p) {
    if (p == 0) planner.hold(poses[p].time_s, poses[p].pose);
    else if (poses[p].pose == poses[p - 1].pose) planner.rest(poses[p].time_s);
    else planner.move(poses[p - 1], poses[p]);
  }
  return planner.plan();
}

}  // namespace sim
