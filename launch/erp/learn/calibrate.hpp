#pragma once
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "launch/erp/learn/course.hpp"
#include "sim/learning/calibration/strategy.hpp"

/// `erp calibrate`: the model fitted to poses in which the robot stood still. Each returns the exit
/// code; all throw xml::Errors, RecordingError and std::invalid_argument for bad input.
namespace launch {

/// What to record: each pose that a trajectory holds, held so long, and midway between neighbours,
/// by their line lengths; as a trajectory for `target`.
struct TourOptions {
  std::string lengths;
  double still_s = 2, way_s = 1.5;
};
int calibrate_tour(const TourOptions& options, std::ostream& out);

/// Recordings, and which of their still poses check: those of `check`, or every second of `learn`.
struct PoseFiles {
  std::vector<std::string> learn, check;
};

struct CalibrateOptions {
  std::string robot, choice;
  PoseFiles poses;
  sim::calibration::StrategyOptions how;
  CourseOptions course;
};
/// Leaves robot.xml, parameters.csv, state.xml, curve.csv and curve.svg.
int calibrate_run(const CalibrateOptions& options, std::ostream& out, std::ostream& remarks);

/// How far a robot.xml is off in poses.
int calibrate_check(const std::string& robot, const PoseFiles& poses, std::ostream& out);

/// A robot.xml that is as far off the poses as asked, by joint, to try a calibration on: parameters
/// drawn at random, scaled muscle by muscle until it is so.
struct PerturbOptions {
  std::string robot, choice, out;
  PoseFiles poses;
  std::map<std::string, double> off_deg;  ///< by joint
  std::uint64_t seed = 1;
};
int calibrate_perturb(const PerturbOptions& options, std::ostream& out);

}  // namespace launch
