#pragma once
#include <span>
#include <string>
#include <vector>

#include "interfaces/xml/fields.hpp"
#include "sim/control/loop_shaping/robust_loop.hpp"
#include "sim/model/actuator/musculoskeletal.hpp"

/// H-infinity loop shaping of a robot's hinges (paper, 5.2), from torques to angles.
///
///   G    H v̇ = τ(t − T) − µ v,  q̇ = v      viscous friction µ, delay T (Padé of order 1);
///                                            τ follows the commanded torque with 1/(1 + T_s s)²
///   W₁ = A k (s + ω_i)/s · (s + z)/(s + α ω_c)               k: such that |W₁ G| ≈ 1 at ω_c
///   z  = max(ω_c/α, µ/h): with large friction no further phase lead is needed
///   A  = H with the diagonal √(h² + (µ/ω_c)²)                1/A: magnitude of G at ω_c
///   K  = W₁ K∞
///
/// K∞ is designed in one posture; A is updated with the posture. The inertia about a joint varies
/// strongly, for example that of the forearm's rotation with the elbow angle, and with a constant A
/// some postures have nearly no margin (on seven_dof, 0.01 instead of 0.39). G does not contain
/// gravity, which is compensated online.
namespace sim::loop_shaping {

/// `<loops crossover_Hz="2.5"/>`, a file.
struct JointShape {
  static constexpr auto element = "loops";
  static constexpr auto description = "Weights of the H-infinity loops of a robot.";
  xml::Place place;
  double crossover_Hz = 2.5;
  double integral_Hz = 0.3;
  double lead = 3;
  double smooth_s = 0.01;
  double delay_s = 0.004;
  void visit(auto& v) {
    v("crossover_Hz", crossover_Hz,
      {xml::positive, "Crossover frequency ω_c/2π of the loops; chosen."});
    v("integral_Hz", integral_Hz,
      {xml::at_least_zero, "Frequency ω_i/2π below which the loops integrate; 0: none; chosen."});
    v("lead", lead, {xml::Range{1, 100}, "Phase lead α around the crossover; 1: none; chosen."});
    v("smooth_s", smooth_s,
      {xml::positive,
       "Time constant T_s with which the torque follows the commanded torque; chosen."});
    v("delay_s", delay_s,
      {xml::positive, "Delay T from a torque to its measured effect: two periods of the ECUs."});
  }
};

/// A joint with a control loop.
struct Hinge {
  std::string name;
  int joint;       ///< index in RobotTree::joints
  int coordinate;  ///< index in SkeletonModel
  double viscous_Nm_s_per_rad, coulomb_Nm;
};
/// Throws std::invalid_argument for a robot with joints that turn about more than one axis.
std::vector<Hinge> hinges_of(const Musculoskeletal& model);

struct JointLoops {
  StateSpace plant, shape;    ///< G; W₁ without A
  Eigen::MatrixXd alignment;  ///< A
  RobustLoop robust;          ///< of G W₁

  StateSpace weight() const { return in_series(shape, constant(alignment)); }  ///< W₁
  /// K without A: from rad to the input of A.
  StateSpace core() const { return in_series(robust.controller, shape); }
  /// Equilibrium states of the core, A x = 0, with output 1 (stored in the integrators of W₁). One
  /// column per output; zero without integrators.
  Eigen::MatrixXd holding() const;
  StateSpace controller() const { return in_series(robust.controller, weight()); }  ///< K
};

/// A for the inertia matrix H. No heap.
void align(const Eigen::MatrixXd& inertia, std::span<const Hinge> hinges, const JointShape& shape,
           Eigen::MatrixXd& alignment);

/// G in the current posture of the model.
StateSpace hinge_plant(Musculoskeletal& model, const JointShape& shape);
/// Designs the loops in the current posture of the model. Throws like hinges_of and stabilised.
JointLoops joint_loops(Musculoskeletal& model, const JointShape& shape);

/// Robustness of loops in a posture.
struct LoopCheck {
  double margin;                     ///< remaining ε
  double slowest_per_s;              ///< largest real part of the closed loop's poles
  double max_sensitivity;            ///< largest singular value of (1 + G K)⁻¹
  std::vector<double> crossover_Hz;  ///< of each joint's loop with the other loops closed
};
LoopCheck checked(const JointLoops& loops);
/// The same K∞ with the G and A of the current posture of the model.
JointLoops moved(const JointLoops& loops, Musculoskeletal& model, const JointShape& shape);

}  // namespace sim::loop_shaping
