#include "sim/learning/calibration/perturb.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "sim/learning/training_loop/random_stream.hpp"
#include "sim/model/actuator/musculoskeletal.hpp"

namespace sim::calibration {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The movable joints that each actuator's muscle crosses, as indices into off_rad.
std::vector<std::vector<std::size_t>> crossed_joints(const erp::Robot& robot) {
  constexpr double min_arm_m = 1e-6;  // chosen: above rounding
  Musculoskeletal model(robot);
  const auto joints = model.tree().joints;
  std::vector<std::vector<std::size_t>> crossed(robot.actuators.size());
  std::size_t index = 0;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const int dofs = coordinates_of(joints[j].type);
    if (dofs == 0) continue;
    const int first = model.skeleton().first_of(static_cast<int>(j));
    for (std::size_t a = 0; a < crossed.size(); ++a)
      if (model.jacobian().block(static_cast<Index>(a), first, 1, dofs).norm() > min_arm_m)
        crossed[a].push_back(index);
    ++index;
  }
  return crossed;
}

VectorXd scaled(const Parameters& parameters, const VectorXd& drawn, const VectorXd& by_joint,
                const std::vector<std::vector<std::size_t>>& crossed) {
  VectorXd x = drawn;
  for (Index k = 0; k < x.size(); ++k) {
    const auto& joints = crossed[parameters.list()[static_cast<std::size_t>(k)].actuator];
    for (const std::size_t j : joints)
      x[k] *= std::pow(by_joint[static_cast<Index>(j)], 1.0 / static_cast<double>(joints.size()));
  }
  return x;
}

/// One draw, scaled until it has the requested errors. nullopt if the scale would exceed its limit.
std::optional<VectorXd> scaled_to_errors(const Parameters& parameters,
                                         std::span<const StillPose> poses,
                                         std::span<const double> off_rad, const VectorXd& drawn,
                                         const std::vector<std::vector<std::size_t>>& crossed) {
  // chosen
  constexpr double ratio_tolerance = 0.05, exponent = 0.3, max_scale = 1.5, min_error_rad = 1e-4;
  constexpr int max_rounds = 30;
  VectorXd by_joint = VectorXd::Constant(std::ssize(off_rad), 0.5);
  for (int round = 0; round < max_rounds && by_joint.maxCoeff() < max_scale; ++round) {
    const VectorXd x = scaled(parameters, drawn, by_joint, crossed);
    const auto error_rad = pose_errors(parameters.at(x), poses).mean_rad;
    bool is_reached = true;
    for (std::size_t j = 0; j < off_rad.size(); ++j) {
      if (std::isnan(off_rad[j])) continue;
      const double ratio = off_rad[j] / std::max(error_rad[j], min_error_rad);
      is_reached = is_reached && std::abs(ratio - 1) < ratio_tolerance;
      by_joint[static_cast<Index>(j)] *= std::clamp(std::pow(ratio, exponent), 0.7, 1.4);
    }
    if (is_reached) return x;
  }
  return std::nullopt;
}

}  // namespace

VectorXd perturbed(const Parameters& parameters, std::span<const StillPose> poses,
                   std::span<const double> off_rad, std::uint64_t seed) {
  constexpr std::uint64_t max_draws = 100;  // chosen
  const auto crossed = crossed_joints(parameters.start().robot);
  for (std::uint64_t draw = 0; draw < max_draws; ++draw) try {
      auto random = training_loop::random_stream(seed, draw);
      std::normal_distribution<double> normal;
      VectorXd drawn(parameters.size());
      for (double& x : drawn) x = normal(random);
      if (const auto x = scaled_to_errors(parameters, poses, off_rad, drawn, crossed)) return *x;
    } catch (const std::invalid_argument&) {  // no equilibrium: a point lies inside its pulley
    }
  throw std::runtime_error(
      "a hundred draws of seed " + std::to_string(seed) +
      " do not reach these errors; request smaller ones, or increase the spreads of <vary>");
}

}  // namespace sim::calibration
