#pragma once
#include <Eigen/Core>
#include <random>

#include "sim/model/skeleton/joint_reading.hpp"
#include "tests/sim/skeletons.hpp"

/// Robots with random parameters.
namespace rigs {

/// Random numbers between bounds; the same seed gives the same numbers.
class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  xml::Vec3 vector(double size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }

 private:
  std::mt19937 random_;
};

/// A robot of two branched trees of eight bodies each, with every joint type except free.
inline erp::Robot random_trees(Draw& draw) {
  std::vector<erp::Body> bodies{root("left"), root("right")};
  std::vector<erp::Joint> joints;
  for (int k = 0; k < 16; ++k) {
    const std::string name = "bone_" + std::to_string(k);
    const std::string parent =
        k < 2 ? bodies[std::size_t(k)].name : "bone_" + std::to_string(k - 1 - k % 2);
    const double a = draw.between(0.01, 0.02);
    bodies.push_back(bone(name, draw.between(0.3, 3), draw.vector(0.1),
                          {a, draw.between(0.01, 0.02), draw.between(0.012, 0.018)}));
    const auto type = k % 5 == 4   ? erp::JointType::fixed
                      : k % 3 == 0 ? erp::JointType::spherical
                                   : erp::JointType::revolute;
    joints.push_back(joint("joint_" + std::to_string(k), type, parent, name, draw.vector(0.3)));
    joints.back().axis = draw.vector(1);
    joints.back().initial_rad = draw.between(-1, 1);
  }
  return robot(bodies, joints);
}

/// A random position and velocity of every joint.
inline std::vector<sim::JointReading> posture(const std::vector<erp::Joint>& joints, Draw& draw) {
  std::vector<sim::JointReading> all;
  for (const auto& joint : joints) {
    sim::JointReading reading{.type = joint.type};
    for (double& v : reading.velocity_rad_per_s) v = draw.between(-3, 3);
    if (joint.type == erp::JointType::spherical) {
      Eigen::Vector4d q(draw.between(-1, 1), draw.between(-1, 1), draw.between(-1, 1),
                        draw.between(0.1, 1));
      q.normalize();
      for (int i = 0; i < 4; ++i) reading.position[static_cast<std::size_t>(i)] = q[i];
    } else {
      reading.position[0] =
          joint.type == erp::JointType::fixed ? joint.initial_rad : draw.between(-2, 2);
    }
    all.push_back(reading);
  }
  return all;
}

}  // namespace rigs
