#pragma once
#include <string>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "sim/model/skeleton/joint_reading.hpp"

/// Joint positions of a recording, row by row.
namespace sim {

/// Throws std::invalid_argument with the name of the missing column.
const recording::Column& column_of(const recording::Table& table, const std::string& name);

/// The columns with the positions of a robot's joints. Refers to the table, which must outlive it.
class RecordedJoints {
 public:
  /// Throws std::invalid_argument with the name of a missing column.
  RecordedJoints(const erp::Robot& robot, const recording::Table& table);
  /// Returns false if a value is missing in that row.
  bool read(std::size_t row, std::vector<JointReading>& joints) const;

 private:
  struct Columns {
    erp::Joint joint;
    std::vector<const recording::Column*> entries;  ///< of JointReading::position
  };
  std::vector<Columns> columns_;
};

}  // namespace sim
