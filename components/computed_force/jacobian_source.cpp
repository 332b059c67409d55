#include "components/computed_force/jacobian_source.hpp"

#include <algorithm>
#include <stdexcept>

#include "interfaces/xml/xml.hpp"
#include "sim/learning/muscle_networks/learned_lengths.hpp"
#include "sim/learning/muscle_networks/length_learner.hpp"
#include "sim/model/actuator/tendon.hpp"

namespace control {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Joints = std::span<const sim::JointReading>;
namespace muscle_networks = sim::muscle_networks;

class Analytic : public JacobianSource {
 public:
  explicit Analytic(const sim::Musculoskeletal& model) : model_(model) {}
  const MatrixXd& at(Joints) override { return model_.jacobian(); }

 private:
  const sim::Musculoskeletal& model_;
};

class Network : public JacobianSource {
 public:
  Network(muscle_networks::LearnedLengths lengths, bool by_difference)
      : lengths_(std::move(lengths)), by_difference_(by_difference) {}
  const MatrixXd& at(Joints joints) override {
    return by_difference_ ? lengths_.jacobian_by_difference(joints) : lengths_.jacobian(joints);
  }

 private:
  muscle_networks::LearnedLengths lengths_;
  bool by_difference_;
};

/// A base (network or robot.xml) with online corrections.
class OnLine : public JacobianSource {
 public:
  OnLine(const erp::Robot& robot, const sim::Musculoskeletal& model,
         std::unique_ptr<muscle_networks::LearnedLengths> network)
      : robot_(robot),
        model_(model),
        network_(std::move(network)),
        learner_({model.tree().joints, model.skeleton()},
                 static_cast<Eigen::Index>(robot.actuators.size()), {}),
        correction_m_(static_cast<Eigen::Index>(robot.actuators.size())),
        jacobian_(model.jacobian()) {
    for (const erp::Actuator& actuator : robot.actuators)
      laws_.push_back(sim::TendonLaw::at_rest(actuator.tendon, actuator.spindle, 0));
  }

  void update(Joints joints, const erp::SensorFrame& frame) override {
    if (!measure(frame)) return;
    correction_m_ -= network_ ? network_->length_m(joints) : model_.length_m();
    learner_.add_sample(joints, correction_m_);
  }
  const MatrixXd& at(Joints joints) override {
    jacobian_ = network_ ? network_->jacobian(joints) : model_.jacobian();
    jacobian_ += learner_.jacobian(joints);
    return jacobian_;
  }

 private:
  static constexpr double min_taut_N = 2;  // chosen: a slack line does not measure the path length

  /// Path lengths from the actuators' measurements, up to constants. False if one is missing.
  bool measure(const erp::SensorFrame& frame) {
    constexpr auto needed = erp::valid::shaft | erp::valid::tension;
    std::size_t measured_count = 0;
    for (const erp::ActuatorSample& sample : erp::samples(frame.actuators))
      for (std::size_t a = 0; a < robot_.actuators.size(); ++a) {
        if (robot_.actuators[a].name != sample.name) continue;
        if ((sample.valid & needed) != needed || !(sample.tension_N > min_taut_N)) return false;
        correction_m_[static_cast<Eigen::Index>(a)] =
            laws_[a].length_m(sample.tension_N, sample.shaft_rad);
        ++measured_count;
      }
    return measured_count == robot_.actuators.size();
  }

  erp::Robot robot_;
  const sim::Musculoskeletal& model_;
  std::unique_ptr<muscle_networks::LearnedLengths> network_;
  muscle_networks::LengthLearner learner_;
  std::vector<sim::TendonLaw> laws_;
  VectorXd correction_m_;
  MatrixXd jacobian_;
};

}  // namespace

std::unique_ptr<JacobianSource> jacobian_source(JacobianKind kind, const std::string& file,
                                                const erp::Robot& robot,
                                                const sim::Musculoskeletal& model) {
  if (kind == JacobianKind::analytic) return std::make_unique<Analytic>(model);
  std::unique_ptr<muscle_networks::LearnedLengths> network;
  if (!file.empty())
    network = std::make_unique<muscle_networks::LearnedLengths>(
        robot, xml::read<muscle_networks::LearnedMuscles>(file));
  if (kind == JacobianKind::on_line)
    return std::make_unique<OnLine>(robot, model, std::move(network));
  if (!network)
    throw std::invalid_argument(
        "a learned Jacobian needs the parameter `muscles`: name a file written by `erp model "
        "muscles`");
  return std::make_unique<Network>(std::move(*network), kind == JacobianKind::difference);
}

}  // namespace control
