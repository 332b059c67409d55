#include <Eigen/Geometry>
#include <algorithm>

#include "sim/world/world.hpp"

namespace sim {

void World::fill(erp::JointState& message) const {
  erp::assign(message.robot, robot_.name);
  erp::assign(message.source, "sim");
  message.joints._length = 0;
  for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
    const JointReading& reading = joints()[j];
    erp::JointStateSample sample{};
    erp::assign(sample.name, tree_.joints[j].name);
    // Of a free body only its rotation; BodyPose contains its position.
    sample.dof = static_cast<std::uint8_t>(std::min(coordinates_of(reading.type), 3));
    std::copy(reading.position.begin(), reading.position.end(), sample.position);
    std::copy(reading.velocity_rad_per_s.begin(), reading.velocity_rad_per_s.end(),
              sample.velocity_rad_per_s);
    erp::append(message.joints, sample);
  }
}

void World::fill(erp::BodyPose& message) const {
  erp::assign(message.robot, robot_.name);
  erp::assign(message.source, "sim");
  message.bodies._length = 0;
  for (std::size_t k = 0; k < tree_.bodies.size(); ++k) {
    const BodyPose& pose = poses()[k];
    const Eigen::Quaterniond q(pose.rotation);
    erp::BodyPoseSample sample{};
    erp::assign(sample.name, tree_.names[k]);
    for (int i = 0; i < 3; ++i) sample.position_m[i] = pose.position_m[i];
    sample.orientation_wxyz[0] = q.w(), sample.orientation_wxyz[1] = q.x();
    sample.orientation_wxyz[2] = q.y(), sample.orientation_wxyz[3] = q.z();
    erp::append(message.bodies, sample);
  }
}

}  // namespace sim
