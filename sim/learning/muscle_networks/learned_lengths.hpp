#pragma once
#include <functional>
#include <string>
#include <vector>

#include "interfaces/xml/fields.hpp"
#include "sim/learning/muscle_networks/perceptron.hpp"
#include "sim/learning/muscle_networks/posture_inputs.hpp"

/// Tendon lengths over postures, learned from samples: one perceptron per muscle (paper, 5.3). Only
/// the derivative of the lengths is used, the muscle Jacobian. A constant of the lengths is
/// unknown.
namespace sim::muscle_networks {

/// Joint positions and path lengths of the tendons.
struct LengthSamples {
  std::vector<std::vector<JointReading>> joints;
  Eigen::MatrixXd length_m;  ///< muscles × samples, each row up to a constant
};

/// One muscle of `<muscles>`, a file: l = centre + spread · net(x).
struct LearnedMuscle {
  static constexpr auto element = "muscle";
  static constexpr auto description = "Network from posture to the length of one tendon.";
  xml::Place place;
  std::string name;
  double centre_m = 0, spread_m = 0, left_m = 0;
  int units = 0;
  std::vector<double> hidden, output;
  void visit(auto& v) {
    v.required("name", name, "Muscle.");
    v.required("centre_m", centre_m, "Length at which the output of the network is 0.");
    v.required("spread_m", spread_m, "Change of length for an output of 1.");
    v("left_m", left_m, "RMS residual of the fit.");
    v.required("units", units, {xml::positive, "Number of hidden units."});
    v.required("hidden", hidden, "Weights of the hidden layer, column by column.");
    v.required("output", output, "Weights of the output layer, column by column.");
  }
};
struct LearnedMuscles {
  static constexpr auto element = "muscles";
  static constexpr auto description = "Learned tendon lengths of a robot.";
  xml::Place place;
  std::string robot;
  std::vector<LearnedMuscle> list;
  void visit(auto& v) {
    v.required("robot", robot, "Robot of the networks.");
    v.list(list);
  }
};

struct LearnOptions {
  int units = 16;  ///< hidden units per muscle; chosen
  std::uint64_t seed = 1;
  FitOptions fit;
  std::function<void(std::size_t done, std::size_t of)> progress = [](std::size_t, std::size_t) {};
};
/// Fits the networks muscle by muscle. Throws std::invalid_argument for too few samples, and
/// like PostureInputs.
LearnedMuscles learn(const erp::Robot& robot, const LengthSamples& samples,
                     const LearnOptions& options = {});

/// Evaluates the learned networks.
class LearnedLengths {
 public:
  /// Throws std::invalid_argument if the file is of another robot or lacks some of its muscles.
  LearnedLengths(const erp::Robot& robot, const LearnedMuscles& learned);

  /// ∂l/∂q, muscles × coordinates, by the networks' own derivative. No heap.
  const Eigen::MatrixXd& jacobian(std::span<const JointReading> joints);
  /// ∂l/∂q by the central difference quotient over ± `step_rad` of each coordinate. No heap.
  const Eigen::MatrixXd& jacobian_by_difference(std::span<const JointReading> joints,
                                                double step_rad = 0.01);
  const Eigen::VectorXd& length_m(std::span<const JointReading> joints);

 private:
  struct Muscle {
    Perceptron net;
    double centre_m, spread_m;
  };
  PostureInputs inputs_;
  std::vector<Muscle> muscles_;
  /// By coordinate: joint and its degree of freedom.
  std::vector<std::pair<std::size_t, int>> joint_of_coordinate_;
  std::vector<JointReading> varied_joints_;
  Eigen::VectorXd x_, dy_dx_, length_m_, forward_length_m_;
  Eigen::MatrixXd slopes_, jacobian_;
};

}  // namespace sim::muscle_networks
