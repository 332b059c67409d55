#include "sim/world/holding.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace sim {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A joint's position, moved by `angle` about coordinate `axis` (spherical: of the child's frame).
JointReading moved(const World& world, int joint, std::array<double, 4> p, int axis, double angle) {
  JointReading reading;
  reading.type = world.joint_list()[joint].type;
  reading.position = p;
  if (reading.type == erp::JointType::revolute) {
    reading.position[0] += angle;
  } else {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)));
    const Eigen::Quaterniond q = Eigen::Quaterniond(p[0], p[1], p[2], p[3]).normalized() * turn;
    reading.position = {q.w(), q.x(), q.y(), q.z()};
  }
  return reading;
}

VectorXd lengths(const World& world) {
  VectorXd l(world.actuators().size());
  for (Eigen::Index k = 0; k < l.size(); ++k) l[k] = world.actuators()[k].length_m;
  return l;
}

void put(World& world, const Pose& pose) {
  for (std::size_t j = 0; j < pose.size(); ++j)
    if (world.joint_list()[j].type != erp::JointType::fixed)
      world.set_joint(static_cast<int>(j), moved(world, static_cast<int>(j), pose[j], 0, 0));
}

/// J and ∂U/∂q at a pose, by central differences.
struct Slopes {
  MatrixXd lengths;  ///< actuators × coordinates
  VectorXd energy;
};

Slopes slopes_at(World& world, const Pose& pose) {
  const double h = 1e-5;
  std::vector<VectorXd> columns;
  std::vector<double> energies;
  for (std::size_t j = 0; j < pose.size(); ++j) {
    const int joint = static_cast<int>(j);
    const auto type = world.joint_list()[j].type;
    const int axes = type == erp::JointType::spherical  ? 3
                     : type == erp::JointType::revolute ? 1
                                                        : 0;
    for (int axis = 0; axis < axes; ++axis) {
      world.set_joint(joint, moved(world, joint, pose[j], axis, h));
      const VectorXd after = lengths(world);
      const double energy_after = world.energy_J();
      world.set_joint(joint, moved(world, joint, pose[j], axis, -h));
      columns.push_back((after - lengths(world)) / (2 * h));
      energies.push_back((energy_after - world.energy_J()) / (2 * h));
      world.set_joint(joint, moved(world, joint, pose[j], axis, 0));
    }
  }
  Slopes s{MatrixXd(world.actuators().size(), columns.size()),
           Eigen::Map<VectorXd>(energies.data(), static_cast<Eigen::Index>(energies.size()))};
  for (std::size_t c = 0; c < columns.size(); ++c) s.lengths.col(c) = columns[c];
  return s;
}

/// f = max(f_min, f_rest + J λ) with Jᵀ f = b.
VectorXd balance(const MatrixXd& j, const VectorXd& b, const HoldingOptions& options) {
  VectorXd lambda = VectorXd::Zero(j.cols());
  const auto tensions = [&](const VectorXd& at) {
    return VectorXd((j * at).array().max(options.least_N - options.rest_N) + options.rest_N);
  };
  for (int k = 0; k < 200; ++k) {
    const VectorXd f = tensions(lambda), missing = b - j.transpose() * f;
    if (missing.norm() < 1e-10) break;
    const VectorXd pulls = ((j * lambda).array() > options.least_N - options.rest_N).cast<double>();
    MatrixXd slope = j.transpose() * pulls.asDiagonal() * j;
    slope.diagonal().array() += 1e-9 + 1e-6 * slope.diagonal().maxCoeff();
    const VectorXd newton = slope.fullPivLu().solve(missing);
    double size = 1;
    while (size > 1e-6 &&
           (b - j.transpose() * tensions(lambda + size * newton)).norm() > missing.norm())
      size /= 2;
    lambda += size * newton;
  }
  return tensions(lambda);
}

}  // namespace

Pose starting_pose(const erp::Robot& robot) {
  const World world(robot);
  Pose pose;
  for (const JointReading& joint : world.joints()) pose.push_back(joint.position);
  return pose;
}

Holding hold_pose(const erp::Robot& robot, const Pose& pose, const HoldingOptions& options) {
  World world(robot);
  const VectorXd start = lengths(world);
  put(world, pose);
  const VectorXd now = lengths(world);
  const Slopes slopes = slopes_at(world, pose);
  const VectorXd f = balance(slopes.lengths, -slopes.energy, options);
  Holding holding;
  holding.unbalanced_Nm = (slopes.lengths.transpose() * f + slopes.energy).norm();
  for (std::size_t k = 0; k < robot.actuators.size(); ++k) {
    const erp::Tendon& tendon = robot.actuators[k].tendon;
    holding.tension_N.push_back(f[static_cast<Eigen::Index>(k)]);
    holding.line_m.push_back(
        now[static_cast<Eigen::Index>(k)] - start[static_cast<Eigen::Index>(k)] -
        (holding.tension_N[k] - tendon.pretension_N) / tendon.stiffness_N_per_m);
  }
  return holding;
}

}  // namespace sim
