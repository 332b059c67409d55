#include "sim/learning/calibration/calibration.hpp"

#include <limits>
#include <numbers>
#include <stdexcept>

namespace sim::calibration {

double error_rad(const Task& task, const Eigen::VectorXd& x) {
  try {
    return pose_errors(task.parameters.at(x), task.poses.learn).mean_of_all_rad;
  } catch (const std::invalid_argument&) {
    return std::numeric_limits<double>::max();
  }
}

namespace {

/// Mean joint errors in degrees, over training poses and over check poses.
std::vector<training_loop::Metric> errors_of(const Candidate& candidate, const PoseSet& poses) {
  constexpr double degree = std::numbers::pi / 180;
  std::vector<training_loop::Metric> metrics;
  const auto add = [&](const char* suffix, std::span<const StillPose> subset) {
    if (subset.empty()) return;
    const PoseErrors errors = pose_errors(candidate, subset);
    std::size_t k = 0;
    for (const erp::Joint& joint : candidate.robot.joints())
      if (coordinates_of(joint.type) > 0)
        metrics.push_back({joint.name + suffix, errors.mean_rad[k++] / degree});
  };
  add(".learned_deg", poses.learn), add(".checked_deg", poses.check);
  return metrics;
}

}  // namespace

Calibration::Calibration(Task task)
    : task_(std::move(task)),
      best_(Eigen::VectorXd::Zero(task_.parameters.size())),
      best_error_rad_(pose_errors(task_.parameters.at(best_), task_.poses.learn).mean_of_all_rad),
      errors_(errors_of(task_.parameters.at(best_), task_.poses)) {}

void Calibration::update_best(const Eigen::VectorXd& x, double error_rad) {
  if (!(error_rad < best_error_rad_)) return;
  best_ = x, best_error_rad_ = error_rad;
  errors_ = errors_of(task_.parameters.at(best_), task_.poses);
}

std::vector<training_loop::Metric> Calibration::metrics() const {
  auto metrics = errors_;
  metrics.push_back({"evaluated_poses", static_cast<double>(evaluated_poses())});
  return metrics;
}

}  // namespace sim::calibration
