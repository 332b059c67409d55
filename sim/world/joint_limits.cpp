#include "sim/world/joint_limits.hpp"

#include <cmath>

namespace sim {
namespace {

constexpr double near_rad = 0.2;   // chosen: 1 ms of motion at 200 rad/s
constexpr double min_sine = 1e-9;  // below: the axis of rotation is undefined

void set_limit(int first, const Eigen::Vector3d& direction, int dofs, double gap_rad, double dt,
               const Eigen::MatrixXd& h, OneSidedForce& force) {
  const auto d = direction.head(dofs);
  const double inertia = d.dot(h.block(first, first, dofs, dofs) * d);
  set_stop(gap_rad, inertia, dt, force);
  force.row.clear();
  for (int k = 0; k < dofs; ++k) force.row.push_back({first + k, direction[k]});
}

}  // namespace

JointLimits::JointLimits(const SkeletonModel& model, std::span<const erp::Joint> joints) {
  for (int j = 0; j < static_cast<int>(joints.size()); ++j)
    if (const int first = model.first_of(j); first >= 0 && joints[j].type != erp::JointType::free)
      stops_.push_back({j, first, joints[j].type == erp::JointType::spherical, joints[j].min_rad,
                        joints[j].max_rad});
}

int JointLimits::find(std::span<const JointReading> joints, const Eigen::MatrixXd& h, double dt,
                      std::span<OneSidedForce> forces) const {
  const Vec3 positive = Vec3::UnitX();
  int count = 0;
  for (const Stop& s : stops_) {
    const auto& q = joints[s.joint].position;
    if (!s.spherical) {
      if (s.max_rad - q[0] < near_rad)
        set_limit(s.first, positive, 1, s.max_rad - q[0], dt, h, forces[count++]);
      if (q[0] - s.min_rad < near_rad)
        set_limit(s.first, -positive, 1, q[0] - s.min_rad, dt, h, forces[count++]);
      continue;
    }
    if (std::abs(q[0]) > std::cos((s.max_rad - near_rad) / 2)) continue;
    const Vec3 v = (q[0] < 0 ? -1.0 : 1.0) * Vec3(q[1], q[2], q[3]);
    const double sine = v.norm(), angle = 2 * std::atan2(sine, std::abs(q[0]));
    if (sine > min_sine) set_limit(s.first, v / sine, 3, s.max_rad - angle, dt, h, forces[count++]);
  }
  return count;
}

}  // namespace sim
