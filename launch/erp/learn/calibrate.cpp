#include "launch/erp/learn/calibrate.hpp"

#include <fmt/format.h>

#include <ostream>

#include "interfaces/xml/xml.hpp"
#include "launch/erp/learn/poses.hpp"
#include "launch/erp/learn/report.hpp"
#include "launch/erp/text/text_files.hpp"
#include "sim/learning/calibration/newton_calibration.hpp"

namespace launch {

namespace calibration = sim::calibration;

int calibrate_check(const std::string& robot_file, const PoseFiles& files, std::ostream& out) {
  const erp::Robot robot = erp::read_robot(robot_file);
  const calibration::Parameters unchanged(robot, {});
  const auto poses = read_poses(robot, files);
  print_errors(robot, poses,
               {errors_of("by statics", unchanged.start(), poses),
                simulated_errors("simulated", robot, poses, 2)},
               out);
  return 0;
}

int calibrate_run(const CalibrateOptions& options, std::ostream& out, std::ostream& remarks) {
  const auto pool = sim::make_pool(options.training.threads);
  const erp::Robot robot = erp::read_robot(options.robot);
  const calibration::Parameters parameters(robot, xml::read<calibration::Choice>(options.choice));
  const auto poses = read_poses(robot, options.poses);
  const auto training = make_calibration({parameters, poses}, options.fit);
  const bool is_complete = run_training(*training, options.training, *pool, remarks);
  const auto slope = turns(parameters, training->best(), poses.learn, *pool).slope;
  if (!pool->first()) return 0;

  const auto identified = calibration::identified(slope, calibration::NewtonOptions{}.sigma_rad);
  const std::string& folder = options.training.folder;
  const erp::Robot calibrated = parameters.robot_at(training->best());
  write_file(folder + "/robot.xml", erp::write_robot(calibrated));
  write_file(folder + "/parameters.csv", parameters_csv(parameters, training->best(), identified));
  print_errors(robot, poses,
               {errors_of("before", parameters.start(), poses),
                errors_of("after", parameters.at(training->best()), poses),
                simulated_errors("simulated", calibrated, poses, options.training.threads)},
               out);
  out << fmt::format("{} rounds, {} poses evaluated\n", training->rounds(),
                     training->evaluated_poses());
  print_identified(parameters, identified, out);
  out << fmt::format(
      "{}/robot.xml is the calibrated robot, curve.svg the course of the calibration\n", folder);
  return is_complete ? 0 : 1;
}

}  // namespace launch
