#include "launch/erp/learn/report.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <ostream>

#include "interfaces/parallel/in_parallel.hpp"
#include "interfaces/recording/csv.hpp"
#include "sim/gap/closed_loop/rest_pose.hpp"

namespace launch {
namespace {

namespace calibration = sim::calibration;
using calibration::Quantity;

/// A parameter with a larger remaining uncertainty, relative to its spread, counts as undetermined;
/// chosen.
constexpr double undetermined_limit = 0.9;

std::vector<std::string> joints_of(const erp::Robot& robot) {
  std::vector<std::string> names;
  for (const erp::Joint& joint : robot.joints())
    if (sim::coordinates_of(joint.type) > 0) names.push_back(joint.name);
  return names;
}

struct Change {
  double amount = 0;
  const char* unit = "";
};

/// The change of a parameter in mm, or in percent for stiffness and radius.
Change change_of(const calibration::Parameter& parameter, double x) {
  const double change = parameter.spread * x;
  const bool is_relative =
      parameter.what == Quantity::stiffness || parameter.what == Quantity::radius;
  return is_relative ? Change{100 * std::expm1(change), "%"} : Change{1e3 * change, "mm"};
}

}  // namespace

ErrorColumn errors_of(const std::string& name, const calibration::Candidate& candidate,
                      const calibration::PoseSet& poses) {
  ErrorColumn column{name, pose_errors(candidate, poses.learn), {}};
  if (!poses.check.empty()) column.checked = pose_errors(candidate, poses.check);
  return column;
}

ErrorColumn simulated_errors(const std::string& name, const erp::Robot& robot,
                             const calibration::PoseSet& poses, int threads) {
  ErrorColumn column{name, {}, {}};
  const std::array parts{std::pair(&poses.learn, &column.learned),
                         std::pair(&poses.check, &column.checked)};
  sim::in_parallel(poses.check.empty() ? 1 : 2, threads, [&](std::size_t k) {
    const std::vector<calibration::StillPose>& part = *parts[k].first;
    std::vector<std::vector<double>> shafts_rad;
    for (const auto& measured : part) shafts_rad.push_back(measured.shaft_rad);
    std::vector<sim::Pose> simulated_poses;
    for (const auto& rest : sim::closed_loop::rest_poses(robot, shafts_rad))
      simulated_poses.push_back(rest.pose);
    *parts[k].second = errors_between(robot, part, simulated_poses);
  });
  return column;
}

void print_errors(const erp::Robot& robot, const calibration::PoseSet& poses,
                  const std::vector<ErrorColumn>& columns, std::ostream& out) {
  constexpr double degree = std::numbers::pi / 180;
  out << fmt::format("{:<24} {:>6}", "mean error, degrees", "poses");
  for (const ErrorColumn& column : columns) out << fmt::format(" {:>10}", column.name);
  const auto names = joints_of(robot);
  const auto rows = [&](const char* set_name, std::size_t count, auto errors) {
    for (std::size_t j = 0; count > 0 && j < names.size(); ++j) {
      out << fmt::format("\n{:<24} {:>6}", names[j] + ", " + set_name, count);
      for (const ErrorColumn& column : columns)
        out << fmt::format(" {:>10.2f}", (column.*errors).mean_rad[j] / degree);
    }
  };
  rows("learned", poses.learn.size(), &ErrorColumn::learned);
  rows("checked", poses.check.size(), &ErrorColumn::checked);
  out << '\n';
}

void print_identified(const calibration::Parameters& parameters,
                      const calibration::Identified& identified, std::ostream& out) {
  std::string names;
  int count = 0;
  for (std::size_t k = 0; k < parameters.list().size(); ++k)
    if (identified.remaining[static_cast<Eigen::Index>(k)] > undetermined_limit)
      names += (count++ ? ", " : "") + parameters.name_of(parameters.list()[k]);
  out << fmt::format("identified: {} combinations of {} parameters\n", identified.combinations,
                     parameters.size());
  if (count > 0)
    out << fmt::format("not identified, uncertain as before ({} of {}): {}\n", count,
                       parameters.size(), names);
}

std::string parameters_csv(const calibration::Parameters& parameters, const Eigen::VectorXd& x,
                           const calibration::Identified& identified) {
  std::string text = "parameter,changed,unit,remaining_uncertainty\n";
  for (std::size_t k = 0; k < parameters.list().size(); ++k) {
    const auto index = static_cast<Eigen::Index>(k);
    const Change change = change_of(parameters.list()[k], x[index]);
    text += fmt::format("{},{:.4g},{},{:.3f}\n",
                        recording::csv_cell(parameters.name_of(parameters.list()[k])),
                        change.amount, change.unit, identified.remaining[index]);
  }
  return text;
}

}  // namespace launch
