#include "sim/learning/muscle_networks/torque_error.hpp"

#include <cmath>
#include <random>

namespace sim::muscle_networks {

using Eigen::Index;
using Eigen::MatrixXd;

TorqueError torque_error(const erp::Robot& robot,
                         std::span<const std::vector<JointReading>> postures,
                         const JacobianAt& learned, std::uint64_t seed) {
  constexpr double min_N = 5;  // chosen
  Musculoskeletal model(robot);
  std::mt19937_64 random(seed);
  const auto muscles = static_cast<Index>(robot.actuators.size());
  Eigen::VectorXd tension_N(muscles), squares = Eigen::VectorXd::Zero(muscles);
  double error_squares = 0, true_squares = 0;
  for (const auto& posture : postures) {
    model.place(posture);
    const MatrixXd difference_m = learned(posture) - model.jacobian();
    for (Index a = 0; a < muscles; ++a)
      tension_N[a] = std::uniform_real_distribution(
          min_N, robot.actuators[static_cast<std::size_t>(a)].max_tension_N / 2)(random);
    error_squares += (difference_m.transpose() * tension_N).squaredNorm();
    true_squares += (model.jacobian().transpose() * tension_N).squaredNorm();
    squares += difference_m.rowwise().squaredNorm() / static_cast<double>(difference_m.cols());
  }
  TorqueError error{std::sqrt(error_squares / true_squares), {}};
  for (Index a = 0; a < muscles; ++a)
    error.moment_arm_m.push_back(std::sqrt(squares[a] / static_cast<double>(postures.size())));
  return error;
}

}  // namespace sim::muscle_networks
