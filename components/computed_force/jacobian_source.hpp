#pragma once
#include <memory>
#include <string>

#include "interfaces/topics.hpp"
#include "sim/model/actuator/musculoskeletal.hpp"

/// Where the muscle Jacobian L(q) = ∂l/∂q comes from (paper, 5.3).
namespace control {

enum class JacobianKind {
  analytic,    ///< from robot.xml's paths
  network,     ///< from perceptrons that `erp model muscles` has learnt, by their derivative
  difference,  ///< the same by difference quotient
  on_line      ///< network or, without one, robot.xml, and what the robot teaches while it moves
};

class JacobianSource {
 public:
  virtual ~JacobianSource() = default;
  /// One sensor frame at these joints, to learn from.
  virtual void hear(std::span<const sim::JointReading>, const erp::SensorFrame&) {}
  /// Muscles × coordinates. No heap.
  virtual const Eigen::MatrixXd& at(std::span<const sim::JointReading> joints) = 0;
};

/// `model`, lent: stands at the joints that are asked for. `muscles_file`: of network and difference.
/// Throws xml::Errors, std::invalid_argument.
std::unique_ptr<JacobianSource> jacobian_source(JacobianKind kind, const std::string& muscles_file,
                                                const erp::Robot& robot,
                                                const sim::Musculoskeletal& model);

}  // namespace control
