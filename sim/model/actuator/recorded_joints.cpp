#include "sim/model/actuator/recorded_joints.hpp"

#include <cmath>
#include <stdexcept>

namespace sim {

using recording::Table;

const recording::Column& column_of(const Table& table, const std::string& name) {
  const recording::Column* column = table.find(name);
  if (!column) throw std::invalid_argument("the recording has no column " + name);
  return *column;
}

RecordedJoints::RecordedJoints(const erp::Robot& robot, const Table& table) {
  for (const erp::Joint& joint : robot.joints()) {
    columns_.push_back({joint, {}});
    if (joint.type == erp::JointType::revolute)
      columns_.back().entries = {&column_of(table, joint.name + ".angle_rad")};
    if (joint.type == erp::JointType::spherical)
      for (const char* entry : {".qw", ".qx", ".qy", ".qz"})
        columns_.back().entries.push_back(&column_of(table, joint.name + entry));
  }
}

bool RecordedJoints::read(std::size_t row, std::vector<JointReading>& joints) const {
  joints.clear();
  for (const Columns& columns : columns_) {
    joints.push_back(initial_reading(columns.joint));
    for (std::size_t k = 0; k < columns.entries.size(); ++k) {
      joints.back().position[k] = columns.entries[k]->values[row];
      if (std::isnan(joints.back().position[k])) return false;
    }
  }
  return true;
}

}  // namespace sim
