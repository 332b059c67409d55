#include "sim/learning/muscle_networks/length_samples.hpp"

#include <cmath>

#include "sim/model/actuator/recorded_joints.hpp"
#include "sim/model/actuator/tendon.hpp"

namespace sim::muscle_networks {
namespace {

using recording::Column;
using recording::Table;

struct Line {
  const Column &shaft, &tension;
  TendonLaw law;
  /// NaN if the tendon is slack.
  double path_m(std::size_t row, double taut_N) const {
    const double force_N = tension.values[row];
    return force_N > taut_N ? law.length_m(force_N, shaft.values[row]) : NAN;
  }
};

}  // namespace

LengthSamples samples_of(const erp::Robot& robot, const Table& table,
                         const SampleOptions& options) {
  const RecordedJoints joints(robot, table);
  std::vector<Line> lines;
  for (const erp::Actuator& actuator : robot.actuators)
    lines.push_back({column_of(table, actuator.name + ".shaft_rad"),
                     column_of(table, actuator.name + ".tension_N"),
                     TendonLaw::at_rest(actuator.tendon, actuator.spindle, 0)});
  LengthSamples samples;
  std::vector<Eigen::VectorXd> lengths;
  std::vector<JointReading> posture;
  Eigen::VectorXd length_m(static_cast<Eigen::Index>(lines.size()));
  for (std::size_t row = 0; row < table.rows(); row += options.every) {
    for (std::size_t a = 0; a < lines.size(); ++a)
      length_m[static_cast<Eigen::Index>(a)] = lines[a].path_m(row, options.taut_N);
    if (!joints.read(row, posture) || !length_m.allFinite()) continue;
    samples.joints.push_back(posture), lengths.push_back(length_m);
  }
  samples.length_m.resize(length_m.size(), static_cast<Eigen::Index>(lengths.size()));
  for (std::size_t k = 0; k < lengths.size(); ++k)
    samples.length_m.col(static_cast<Eigen::Index>(k)) = lengths[k];
  return samples;
}

}  // namespace sim::muscle_networks
