#include "sim/learning/calibration/perturb.hpp"

#include <fmt/format.h>

#include <limits>
#include <numbers>
#include <ostream>

#include "interfaces/xml/xml.hpp"
#include "launch/erp/learn/poses.hpp"
#include "launch/erp/learn/report.hpp"
#include "launch/erp/text/text_files.hpp"

namespace launch {

namespace calibration = sim::calibration;

namespace {

/// The requested error of each movable joint, in the order of the robot; NaN if none was requested.
std::vector<double> pose_errors_rad(const erp::Robot& robot,
                                    std::map<std::string, double> pose_errors_deg) {
  std::vector<double> errors_rad;
  for (const erp::Joint& joint : robot.joints()) {
    if (sim::coordinates_of(joint.type) == 0) continue;
    const auto requested = pose_errors_deg.extract(joint.name);
    errors_rad.push_back(requested ? requested.mapped() * std::numbers::pi / 180
                                   : std::numeric_limits<double>::quiet_NaN());
  }
  if (!pose_errors_deg.empty())
    throw std::invalid_argument("robot \"" + robot.name + "\" has no joint \"" +
                                pose_errors_deg.begin()->first +
                                "\" that moves; name one of its movable joints");
  return errors_rad;
}

}  // namespace

int calibrate_perturb(const PerturbOptions& options, std::ostream& out) {
  const erp::Robot robot = erp::read_robot(options.robot);
  const calibration::Parameters parameters(robot, xml::read<calibration::Choice>(options.choice));
  const auto poses = read_poses(robot, options.poses);
  const auto x = perturbed(parameters, poses.learn, pose_errors_rad(robot, options.pose_errors_deg),
                           options.seed);
  write_file(options.out, erp::write_robot(parameters.robot_at(x)));
  print_errors(robot, poses,
               {errors_of("as given", parameters.start(), poses),
                errors_of("perturbed", parameters.at(x), poses)},
               out);
  return 0;
}

}  // namespace launch
