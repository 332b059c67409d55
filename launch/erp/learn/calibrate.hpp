#pragma once
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "launch/erp/learn/training_run.hpp"
#include "sim/learning/calibration/strategy.hpp"

/// `erp calibrate`: fits the model to poses of the robot at rest. Each function returns the exit
/// code; all throw xml::Errors, RecordingError and std::invalid_argument for bad input.
namespace launch {

/// Prints the motion to record, as a trajectory for the component `target`: each pose that the
/// trajectory `lengths` holds, and the mean line lengths of consecutive poses. Holds each of them
/// for `hold_s`.
struct TourOptions {
  std::string lengths;  ///< file with a trajectory of line lengths
  double hold_s = 2, move_s = 1.5;
};
int calibrate_tour(const TourOptions& options, std::ostream& out);

/// Files of recordings with training poses and check poses. If `check` is empty, every second pose
/// of `learn` is a check pose.
struct PoseFiles {
  std::vector<std::string> learn, check;
};

struct CalibrateOptions {
  std::string robot, choice;
  PoseFiles poses;
  sim::calibration::StrategyOptions fit;
  TrainingRunOptions training;
};
/// Writes robot.xml, parameters.csv, state.xml, curve.csv and curve.svg.
int calibrate_run(const CalibrateOptions& options, std::ostream& out, std::ostream& remarks);

/// Prints the pose errors of a robot.xml.
int calibrate_check(const std::string& robot, const PoseFiles& poses, std::ostream& out);

/// Writes a robot.xml with the requested pose errors of the joints, to test a calibration. Draws
/// random parameter changes and scales them muscle by muscle.
struct PerturbOptions {
  std::string robot, choice, out;
  PoseFiles poses;
  std::map<std::string, double> pose_errors_deg;  ///< mean error by joint
  std::uint64_t seed = 1;
};
int calibrate_perturb(const PerturbOptions& options, std::ostream& out);

}  // namespace launch
