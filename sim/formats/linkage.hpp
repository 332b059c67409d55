#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/formats/foreign.hpp"

/// The skeleton in the form of other formats: links and joints in the zero pose, in world
/// coordinates. Their frames may be rotated, whereas the frames of robot.xml are parallel.
namespace formats {

using Vec3 = Eigen::Vector3d;

struct Link {
  std::string name;
  double mass_kg = 0;
  Vec3 com_m = Vec3::Zero();
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();  ///< about the centre of mass
};

struct Connection {
  std::string name, parent, child;
  erp::JointType type = erp::JointType::fixed;
  Vec3 at_m = Vec3::Zero(), axis = Vec3::UnitX();
  double min_rad = -3.14159, max_rad = 3.14159;
  double viscous_Nm_s_per_rad = 0, coulomb_Nm = 0;
};

struct Linkage {
  std::string name;
  std::vector<Link> links;
  std::vector<Connection> joints;
};

/// The robot of a linkage, without motors and tendons. A link without mass that is fixed to another
/// link is merged with that link. Three hinges about x, y, z through one point over links without
/// mass become a ball joint. A root is fixed and its mass is ignored. Throws std::invalid_argument
/// for an invalid joint.
erp::Robot robot_of(Linkage linkage);

/// Positions of the bodies' frames in the world, all joints at zero, in the order of
/// robot.bodies().
std::vector<Vec3> origins_of(const erp::Robot& robot);

/// A pose from "x y z roll pitch yaw".
Eigen::Isometry3d pose_of(const std::vector<double>& xyz_rpy);

}  // namespace formats
