#include "sim/learning/length_samples.hpp"

#include <cmath>
#include <stdexcept>

#include "sim/actuator/tendon.hpp"

namespace sim::learning {
namespace {

using recording::Column;
using recording::Table;

const Column& column(const Table& table, const std::string& name) {
  const Column* found = table.find(name);
  if (!found) throw std::invalid_argument("the recording has no column " + name);
  return *found;
}

/// A joint's columns, by entry of JointReading::position.
struct JointColumns {
  erp::Joint joint;
  std::vector<const Column*> entries;
};

std::vector<JointColumns> joint_columns(const erp::Robot& robot, const Table& table) {
  std::vector<JointColumns> all;
  for (const erp::Joint& joint : robot.joints()) {
    all.push_back({joint, {}});
    if (joint.type == erp::JointType::revolute)
      all.back().entries = {&column(table, joint.name + ".angle_rad")};
    if (joint.type == erp::JointType::spherical)
      for (const char* entry : {".qw", ".qx", ".qy", ".qz"})
        all.back().entries.push_back(&column(table, joint.name + entry));
  }
  return all;
}

/// False: not all are known in that row.
bool read(const std::vector<JointColumns>& columns, std::size_t row,
          std::vector<JointReading>& joints) {
  joints.clear();
  for (const JointColumns& one : columns) {
    joints.push_back(start_of(one.joint));
    for (std::size_t k = 0; k < one.entries.size(); ++k) {
      joints.back().position[k] = one.entries[k]->values[row];
      if (std::isnan(joints.back().position[k])) return false;
    }
  }
  return true;
}

struct Line {
  const Column &shaft, &tension;
  TendonLaw law;
  /// NaN: not known.
  double path_m(std::size_t row, double taut_N) const {
    const double force_N = tension.values[row];
    return force_N > taut_N ? law.length_m(force_N, shaft.values[row]) : NAN;
  }
};

}  // namespace

LengthSamples samples_of(const erp::Robot& robot, const Table& table,
                         const SampleOptions& options) {
  const auto joints = joint_columns(robot, table);
  std::vector<Line> lines;
  for (const erp::Actuator& actuator : robot.actuators)
    lines.push_back({column(table, actuator.name + ".shaft_rad"),
                     column(table, actuator.name + ".tension_N"),
                     TendonLaw::at_rest(actuator.tendon, actuator.spindle, 0)});
  LengthSamples samples;
  std::vector<Eigen::VectorXd> lengths;
  std::vector<JointReading> now;
  Eigen::VectorXd length_m(static_cast<Eigen::Index>(lines.size()));
  for (std::size_t row = 0; row < table.rows(); row += options.every) {
    for (std::size_t a = 0; a < lines.size(); ++a)
      length_m[static_cast<Eigen::Index>(a)] = lines[a].path_m(row, options.taut_N);
    if (!read(joints, row, now) || !length_m.allFinite()) continue;
    samples.joints.push_back(now), lengths.push_back(length_m);
  }
  samples.length_m.resize(length_m.size(), static_cast<Eigen::Index>(lengths.size()));
  for (std::size_t k = 0; k < lengths.size(); ++k)
    samples.length_m.col(static_cast<Eigen::Index>(k)) = lengths[k];
  return samples;
}

}  // namespace sim::learning
