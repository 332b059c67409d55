#pragma once
#include <string>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "sim/model/skeleton/joint_reading.hpp"

/// A recording's joints, row by row.
namespace sim {

/// Throws std::invalid_argument naming a column that is not there.
const recording::Column& column_of(const recording::Table& table, const std::string& name);

/// The columns that say where a robot's joints are; lent.
class RecordedJoints {
 public:
  /// Throws std::invalid_argument naming a joint's column that is not there.
  RecordedJoints(const erp::Robot& robot, const recording::Table& table);
  /// False: not all are known in that row.
  bool read(std::size_t row, std::vector<JointReading>& joints) const;

 private:
  struct Columns {
    erp::Joint joint;
    std::vector<const recording::Column*> entries;  ///< of JointReading::position
  };
  std::vector<Columns> columns_;
};

}  // namespace sim
