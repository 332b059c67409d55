#pragma once
#include <iosfwd>
#include <string>

#include "sim/learning/calibration/sensitivity.hpp"

/// Reports of a calibration.
namespace launch {

/// Errors of one robot.xml, by statics or by simulation.
struct ErrorColumn {
  std::string name;
  sim::calibration::PoseErrors learned, checked;  ///< checked: empty without check poses
};
/// Errors of the static equilibria.
ErrorColumn errors_of(const std::string& name, const sim::calibration::Candidate& candidate,
                      const sim::calibration::PoseSet& poses);
/// Errors in the simulator, which runs the poses one after the other, training and check poses in
/// parallel. Throws as sim::closed_loop::rest_poses does.
ErrorColumn simulated_errors(const std::string& name, const erp::Robot& robot,
                             const sim::calibration::PoseSet& poses, int threads);
/// Prints one row per joint: mean errors in degrees, over training poses and over check poses.
void print_errors(const erp::Robot& robot, const sim::calibration::PoseSet& poses,
                  const std::vector<ErrorColumn>& columns, std::ostream& out);

/// Prints the parameters that the poses do not determine.
void print_identified(const sim::calibration::Parameters& parameters,
                      const sim::calibration::Identified& identified, std::ostream& out);

/// One row per parameter: `parameter,changed,unit,remaining_uncertainty`. The uncertainty is relative
/// to the spread of the parameter, 0 … 1.
std::string parameters_csv(const sim::calibration::Parameters& parameters, const Eigen::VectorXd& x,
                           const sim::calibration::Identified& identified);

}  // namespace launch
