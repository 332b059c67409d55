#pragma once
#include <functional>
#include <string>
#include <vector>

#include "interfaces/xml/fields.hpp"
#include "sim/learning/muscle_networks/perceptron.hpp"
#include "sim/learning/muscle_networks/posture_inputs.hpp"

/// Lengths of tendons over postures, learnt from samples: a perceptron a muscle (paper, 5.3). What
/// counts is the derivative, the muscle Jacobian; a constant in the lengths is not known.
namespace sim::muscle_networks {

/// Where the joints were, and how long the tendons' paths.
struct LengthSamples {
  std::vector<std::vector<JointReading>> joints;
  Eigen::MatrixXd length_m;  ///< muscles × samples, each row up to a constant
};

/// One muscle of `<muscles>`, a file: l = centre + spread · net(x).
struct LearntMuscle {
  static constexpr auto element = "muscle";
  xml::Place place;
  std::string name;
  double centre_m = 0, spread_m = 0, left_m = 0;  ///< left: RMS of what the fit leaves
  int units = 0;
  std::vector<double> hidden, output;  ///< column by column
  void visit(auto& v) {
    v.required("name", name);
    v.required("centre_m", centre_m);
    v.required("spread_m", spread_m);
    v("left_m", left_m);
    v.required("units", units, xml::positive);
    v.required("hidden", hidden), v.required("output", output);
  }
};
struct LearntMuscles {
  static constexpr auto element = "muscles";
  xml::Place place;
  std::string robot;
  std::vector<LearntMuscle> list;
  void visit(auto& v) {
    v.required("robot", robot);
    v.list(list);
  }
};

struct LearnOptions {
  int units = 16;  ///< hidden ones a muscle; chosen
  std::uint64_t seed = 1;
  FitOptions fit;
  std::function<void(std::size_t done, std::size_t of)> progress = [](std::size_t, std::size_t) {};
};
/// Muscle by muscle. Throws std::invalid_argument for too few samples, and as PostureInputs.
LearntMuscles learn(const erp::Robot& robot, const LengthSamples& samples,
                    const LearnOptions& options = {});

/// What has been learnt, at work.
class LearntLengths {
 public:
  /// Throws std::invalid_argument where the file is of another robot, or has not all its muscles.
  LearntLengths(const erp::Robot& robot, const LearntMuscles& learnt);

  /// ∂l/∂q, muscles × coordinates, by the networks' own derivative. No heap.
  const Eigen::MatrixXd& jacobian(std::span<const JointReading> joints);
  /// The same by the central difference quotient over ± `step_rad` of each coordinate. No heap.
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
  std::vector<std::pair<std::size_t, int>> moved_by_;  ///< by coordinate: joint, and which turn
  std::vector<JointReading> moved_;
  Eigen::VectorXd x_, dy_dx_, length_m_, ahead_m_;
  Eigen::MatrixXd slopes_, jacobian_;
};

}  // namespace sim::muscle_networks
