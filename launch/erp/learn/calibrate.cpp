#include "launch/erp/learn/calibrate.hpp"

#include <fmt/format.h>

#include <ostream>

#include "interfaces/xml/xml.hpp"
#include "launch/erp/learn/poses.hpp"
#include "launch/erp/learn/report.hpp"
#include "launch/erp/text/text_files.hpp"
#include "sim/learning/calibration/newton_learner.hpp"

namespace launch {

namespace calibration = sim::calibration;

int calibrate_check(const std::string& robot_file, const PoseFiles& files, std::ostream& out) {
  const erp::Robot robot = erp::read_robot(robot_file);
  const calibration::Parameters none(robot, {});
  const auto poses = read_poses(robot, files);
  print_errors(robot, poses,
               {errors_of("by statics", none.start(), poses),
                simulated_errors("simulated", robot, poses, 2)},
               out);
  return 0;
}

int calibrate_run(const CalibrateOptions& options, std::ostream& out, std::ostream& remarks) {
  const auto pool = sim::make_pool(options.course.threads);
  const erp::Robot robot = erp::read_robot(options.robot);
  const calibration::Parameters parameters(robot, xml::read<calibration::Choice>(options.choice));
  const auto poses = read_poses(robot, options.poses);
  const auto learner = make_calibration({parameters, poses}, options.how);
  const bool ended = run_course(*learner, options.course, *pool, remarks);
  const auto slope = turns(parameters, learner->best(), poses.learn, *pool).slope;
  if (!pool->first()) return 0;

  const auto identified = calibration::identified(slope, calibration::NewtonOptions{}.sigma_rad);
  const std::string& folder = options.course.folder;
  const erp::Robot calibrated = parameters.robot_at(learner->best());
  write_file(folder + "/robot.xml", erp::write_robot(calibrated));
  write_file(folder + "/parameters.csv", parameters_csv(parameters, learner->best(), identified));
  print_errors(robot, poses,
               {errors_of("before", parameters.start(), poses),
                errors_of("after", parameters.at(learner->best()), poses),
                simulated_errors("simulated", calibrated, poses, options.course.threads)},
               out);
  out << fmt::format("after {} rounds, {} poses judged\n", learner->rounds(),
                     learner->judged_poses());
  print_identified(parameters, identified, out);
  out << fmt::format("{}/robot.xml is the calibrated robot, curve.svg how it came to be\n", folder);
  return ended ? 0 : 1;
}

}  // namespace launch
