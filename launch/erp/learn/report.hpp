#pragma once
#include <iosfwd>
#include <string>

#include "sim/learning/calibration/sensitivity.hpp"

/// Reports of a calibration.
namespace launch {

/// Pose errors of one robot.xml, computed by statics or by simulation.
struct ErrorColumn {
  std::string name;
  sim::calibration::PoseErrors learned, checked;  ///< checked: empty without check poses
};
/// Differences between measured poses and static equilibria of a candidate.
ErrorColumn errors_of(const std::string& name, const sim::calibration::Candidate& candidate,
                      const sim::calibration::PoseSet& poses);
/// Differences between measured poses and rest poses in the simulator, which simulates the poses
/// one after the other. Training poses and check poses run in parallel. Throws the exceptions of
/// sim::closed_loop::rest_poses.
ErrorColumn simulated_errors(const std::string& name, const erp::Robot& robot,
                             const sim::calibration::PoseSet& poses, int threads);
/// Prints one row per joint and set of poses: the mean errors in degrees over training poses and
/// check poses.
void print_errors(const erp::Robot& robot, const sim::calibration::PoseSet& poses,
                  const std::vector<ErrorColumn>& columns, std::ostream& out);

/// Prints the parameters that the poses do not determine.
void print_identified(const sim::calibration::Parameters& parameters,
                      const sim::calibration::Identified& identified, std::ostream& out);

/// A CSV text with one row per parameter: `parameter,changed,unit,remaining_uncertainty`. The
/// uncertainty is relative to the spread of the parameter, 0 … 1.
std::string parameters_csv(const sim::calibration::Parameters& parameters, const Eigen::VectorXd& x,
                           const sim::calibration::Identified& identified);

}  // namespace launch
