#pragma once
#include <functional>

#include "sim/model/actuator/musculoskeletal.hpp"

namespace sim::muscle_networks {

using JacobianAt = std::function<const Eigen::MatrixXd&(std::span<const JointReading>)>;

/// How far the torques that a learnt Jacobian counts with are off those of the robot's:
///
///   e = √(Σ ‖(L̂ − L)ᵀ f‖² / Σ ‖Lᵀ f‖²)     over postures, in each tensions f of 5 N to half of
///                                            what each muscle may pull, drawn
struct TorqueError {
  double share = 0;                  ///< e
  std::vector<double> moment_arm_m;  ///< by muscle, RMS of L̂ − L over postures and coordinates
};
TorqueError torque_error(const erp::Robot& robot,
                         std::span<const std::vector<JointReading>> postures,
                         const JacobianAt& learnt, std::uint64_t seed = 1);

}  // namespace sim::muscle_networks
