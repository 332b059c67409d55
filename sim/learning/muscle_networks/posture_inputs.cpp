#include "sim/learning/muscle_networks/posture_inputs.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

namespace sim::muscle_networks {

PostureInputs::PostureInputs(std::span<const erp::Joint> joints, const SkeletonModel& model)
    : coordinates_(model.coordinates()) {
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const erp::Joint& joint = joints[j];
    const int first = model.first_of(static_cast<int>(j));
    if (first < 0) continue;
    if (joint.type == erp::JointType::free)
      throw std::invalid_argument("joint \"" + joint.name +
                                  "\" is free: lengths cannot be learned over a free joint");
    const bool is_ball = joint.type == erp::JointType::spherical;
    parts_.push_back({j, size_, first, is_ball});
    size_ += is_ball ? 9 : 2;
  }
}

void PostureInputs::read(std::span<const JointReading> joints, Eigen::VectorXd& x) const {
  x.resize(size_);
  for (const Part& part : parts_) {
    const auto& q = joints[part.joint].position;
    if (part.is_ball)
      x.segment<9>(part.input) =
          Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix().reshaped();
    else x[part.input] = std::cos(q[0]), x[part.input + 1] = std::sin(q[0]);
  }
}

void PostureInputs::slopes(const Eigen::VectorXd& x, Eigen::MatrixXd& dx_dq) const {
  dx_dq.setZero(size_, coordinates_);
  for (const Part& part : parts_) {
    if (!part.is_ball) {
      dx_dq(part.input, part.coordinate) = -x[part.input + 1];
      dx_dq(part.input + 1, part.coordinate) = x[part.input];
      continue;
    }
    // R [e_k]×: column (k + 1) becomes R's column (k + 2), and (k + 2) minus R's (k + 1).
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3, last = (k + 2) % 3;
      const auto column = [&](int c) { return x.segment<3>(part.input + 3 * c); };
      dx_dq.block<3, 1>(part.input + 3 * next, part.coordinate + k) = column(last);
      dx_dq.block<3, 1>(part.input + 3 * last, part.coordinate + k) = -column(next);
    }
  }
}

}  // namespace sim::muscle_networks
