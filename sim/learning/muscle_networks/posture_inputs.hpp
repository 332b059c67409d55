#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "sim/model/skeleton/joint_reading.hpp"
#include "sim/model/skeleton/skeleton_model.hpp"

/// Joint positions as inputs of a network, without gimbal lock:
///
///   revolute   x = (cos q, sin q)
///   spherical  x = the nine entries of its rotation matrix R, column by column
///
/// The squared distance between points on two bodies is linear in these inputs. The length of a
/// straight muscle is therefore easy to learn.
namespace sim::muscle_networks {

class PostureInputs {
 public:
  /// Throws std::invalid_argument for a robot with free joints.
  PostureInputs(std::span<const erp::Joint> joints, const SkeletonModel& model);

  int size() const { return size_; }
  int coordinates() const { return coordinates_; }
  /// x of the given joint readings. No heap.
  void read(std::span<const JointReading> joints, Eigen::VectorXd& x) const;
  /// ∂x/∂q at x, inputs × coordinates: for ball joints by rotation in the child's frame,
  /// ∂R/∂ω_k = R [e_k]×. No heap.
  void slopes(const Eigen::VectorXd& x, Eigen::MatrixXd& dx_dq) const;

 private:
  struct Part {
    std::size_t joint;
    int input, coordinate;
    bool is_ball;
  };
  std::vector<Part> parts_;
  int size_ = 0, coordinates_ = 0;
};

}  // namespace sim::muscle_networks
