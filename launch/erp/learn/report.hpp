#pragma once
#include <iosfwd>
#include <string>

#include "sim/learning/calibration/sensitivity.hpp"

/// What a calibration found, for people.
namespace launch {

/// One robot.xml, or one way to find where it stands.
struct ErrorColumn {
  std::string name;
  sim::calibration::PoseErrors learnt, checked;  ///< checked: empty where no pose is to check
};
/// By statics.
ErrorColumn errors_of(const std::string& name, const sim::calibration::Candidate& candidate,
                      const sim::calibration::PoseSet& poses);
/// In the simulator, one pose after the other; those learnt from beside those that check. Throws as
/// sim::closed_loop::standings does.
ErrorColumn simulated_errors(const std::string& name, const erp::Robot& robot,
                             const sim::calibration::PoseSet& poses, int threads);
/// A row a joint: mean angles off, degrees, in poses to learn from and to check with.
void print_errors(const erp::Robot& robot, const sim::calibration::PoseSet& poses,
                  const std::vector<ErrorColumn>& columns, std::ostream& out);

/// Which parameters the poses say nothing of.
void print_identified(const sim::calibration::Parameters& parameters,
                      const sim::calibration::Identified& identified, std::ostream& out);

/// A row a parameter: `parameter,changed,unit,left`; left: what is open of its spread, 0 … 1.
std::string parameters_csv(const sim::calibration::Parameters& parameters, const Eigen::VectorXd& x,
                           const sim::calibration::Identified& identified);

}  // namespace launch
