#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "sim/model/skeleton/joint_reading.hpp"

/// The angle between two readings of a joint.
inline double angle_between_rad(const sim::JointReading& a, const sim::JointReading& b) {
  const auto &p = a.position, &q = b.position;
  const Eigen::Quaterniond from(p[0], p[1], p[2], p[3]), to(q[0], q[1], q[2], q[3]);
  return sim::coordinates_of(a.type) >= 3 ? from.angularDistance(to) : std::abs(p[0] - q[0]);
}

/// The largest of all joints.
inline double angle_between_rad(std::span<const sim::JointReading> a,
                                std::span<const sim::JointReading> b) {
  double largest_rad = 0;
  for (std::size_t j = 0; j < a.size(); ++j)
    largest_rad = std::max(largest_rad, angle_between_rad(a[j], b[j]));
  return largest_rad;
}
