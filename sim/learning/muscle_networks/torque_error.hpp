#pragma once
#include <functional>

#include "sim/model/actuator/musculoskeletal.hpp"

namespace sim::muscle_networks {

using JacobianAt = std::function<const Eigen::MatrixXd&(std::span<const JointReading>)>;

/// Error of the torques computed with a learned Jacobian L̂, relative to the robot's Jacobian L:
///
///   e = √(Σ ‖(L̂ − L)ᵀ f‖² / Σ ‖Lᵀ f‖²)     over postures, each with random tensions f of 5 N to half of
///                                            each muscle's maximum
struct TorqueError {
  double share = 0;                  ///< e
  std::vector<double> moment_arm_m;  ///< by muscle, RMS of L̂ − L over postures and coordinates
};
TorqueError torque_error(const erp::Robot& robot,
                         std::span<const std::vector<JointReading>> postures,
                         const JacobianAt& learned, std::uint64_t seed = 1);

}  // namespace sim::muscle_networks
