#pragma once
#include <memory>
#include <string>

#include "interfaces/topics.hpp"
#include "sim/model/actuator/musculoskeletal.hpp"

/// Sources of the muscle Jacobian L(q) = ∂l/∂q (paper, 5.3).
namespace control {

enum class JacobianKind {
  analytic,    ///< from robot.xml's paths
  network,     ///< derivative of perceptrons that `erp model muscles` has trained
  difference,  ///< difference quotient of the same perceptrons
  on_line      ///< network if given, else robot.xml; plus corrections learned during motion
};

class JacobianSource {
 public:
  virtual ~JacobianSource() = default;
  /// Learns from a sensor frame at the given joints.
  virtual void update(std::span<const sim::JointReading>, const erp::SensorFrame&) {}
  /// Muscles × coordinates. No heap.
  virtual const Eigen::MatrixXd& at(std::span<const sim::JointReading> joints) = 0;
};

/// `model` must outlive the result and must be placed at the joints passed to `at`. `muscles_file`
/// is required by network and difference. Throws xml::Errors, std::invalid_argument.
std::unique_ptr<JacobianSource> jacobian_source(JacobianKind kind, const std::string& muscles_file,
                                                const erp::Robot& robot,
                                                const sim::Musculoskeletal& model);

}  // namespace control
