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
std::vector<std::vector<std::size_t>> crossed_by(const erp::Robot& robot) {
  Musculoskeletal model(robot);
  const auto joints = model.tree().joints;
  std::vector<std::vector<std::size_t>> crossed(robot.actuators.size());
  std::size_t place = 0;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const int dofs = coordinates_of(joints[j].type);
    if (dofs == 0) continue;
    const int first = model.skeleton().first_of(static_cast<int>(j));
    for (std::size_t a = 0; a < crossed.size(); ++a)
      if (model.jacobian().block(static_cast<Index>(a), first, 1, dofs).norm() > 1e-6)
        crossed[a].push_back(place);
    ++place;
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

/// One draw, scaled until its errors are as requested; nullopt if the scale would exceed its limit.
std::optional<VectorXd> scaled_to_errors(const Parameters& parameters,
                                         std::span<const StillPose> poses,
                                         std::span<const double> off_rad, const VectorXd& drawn,
                                         const std::vector<std::vector<std::size_t>>& crossed) {
  constexpr int most_rounds = 30;
  constexpr double near = 0.05, soft = 0.3, most_scale = 1.5;
  VectorXd by_joint = VectorXd::Constant(std::ssize(off_rad), 0.5);
  for (int round = 0; round < most_rounds && by_joint.maxCoeff() < most_scale; ++round) {
    const VectorXd x = scaled(parameters, drawn, by_joint, crossed);
    const auto off = pose_errors(parameters.at(x), poses).mean_rad;
    bool there = true;
    for (std::size_t j = 0; j < off_rad.size(); ++j) {
      if (std::isnan(off_rad[j])) continue;
      const double ratio = off_rad[j] / std::max(off[j], 1e-4);
      there = there && std::abs(ratio - 1) < near;
      by_joint[static_cast<Index>(j)] *= std::clamp(std::pow(ratio, soft), 0.7, 1.4);
    }
    if (there) return x;
  }
  return std::nullopt;
}

}  // namespace

VectorXd perturbed(const Parameters& parameters, std::span<const StillPose> poses,
                   std::span<const double> off_rad, std::uint64_t seed) {
  constexpr std::uint64_t most_draws = 100;
  const auto crossed = crossed_by(parameters.start().robot);
  for (std::uint64_t draw = 0; draw < most_draws; ++draw) try {
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
