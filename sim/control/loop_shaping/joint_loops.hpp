#pragma once
#include <span>
#include <string>
#include <vector>

#include "interfaces/xml/fields.hpp"
#include "sim/model/actuator/musculoskeletal.hpp"
#include "sim/control/loop_shaping/robust_loop.hpp"

/// H-infinity loop shaping of a robot's hinges (paper, 5.2), from torques to angles.
///
///   G    H v̇ = τ(t − T) − µ v,  q̇ = v      viscous friction µ, delay T (Padé of order 1);
///                                            τ follows what is asked by 1/(1 + T_s s)²
///   W₁ = A k (s + ω_i)/s · (s + z)/(s + α ω_c)               k: |W₁ G| is about 1 at ω_c
///   z  = ω_c/α, or µ/h where that is more: friction alone then gives the phase
///   A  = H but for its diagonal, √(h² + (µ/ω_c)²)            1/A is G at ω_c, its phase aside
///   K  = W₁ K∞
///
/// K∞ is designed in one posture. A follows the posture: the inertia that a joint has to move
/// changes manifold, that of a forearm's rotation as the elbow bends, and no fixed A keeps a margin
/// over all (seven_dof: 0.01 of 0.39 are left). Gravity is not in G: it is compensated on line.
namespace sim::loop_shaping {

/// `<loops crossover_Hz="2.5"/>`, a file.
struct JointShape {
  static constexpr auto element = "loops";
  xml::Place place;
  double crossover_Hz = 2.5;  ///< ω_c/2π
  double integral_Hz = 0.3;   ///< ω_i/2π
  double lead = 3;            ///< α; 1: none
  double smooth_s = 0.01;     ///< T_s
  double delay_s = 0.004;     ///< T: two of the ECUs' periods
  void visit(auto& v) {
    v("crossover_Hz", crossover_Hz, xml::positive);
    v("integral_Hz", integral_Hz, xml::at_least_zero);
    v("lead", lead, xml::Range{1, 100});
    v("smooth_s", smooth_s, xml::positive);
    v("delay_s", delay_s, xml::positive);
  }
};

/// A joint that a loop can be closed around.
struct Hinge {
  std::string name;
  int joint;       ///< of RobotTree::joints
  int coordinate;  ///< of SkeletonModel
  double viscous_Nm_s_per_rad, coulomb_Nm;
};
/// Throws std::invalid_argument for a robot with joints that turn about more than one axis.
std::vector<Hinge> hinges_of(const Musculoskeletal& model);

struct JointLoops {
  StateSpace plant, shape;    ///< G; W₁ without A
  Eigen::MatrixXd alignment;  ///< A
  RobustLoop robust;          ///< of G W₁

  StateSpace weight() const { return in_series(shape, constant(alignment)); }  ///< W₁
  /// From rad to what A turns into Nm.
  StateSpace core() const { return in_series(robust.controller, shape); }
  /// The core's states of rest, A x = 0, that ask for 1 of an output: what W₁'s integrators hold. A
  /// column for each output; zero without integrators.
  Eigen::MatrixXd holding() const;
  StateSpace controller() const { return in_series(robust.controller, weight()); }  ///< K
};

/// A where the bones have inertia H. No heap.
void align(const Eigen::MatrixXd& inertia, std::span<const Hinge> hinges, const JointShape& shape,
           Eigen::MatrixXd& alignment);

/// G where the model is placed now.
StateSpace hinge_plant(Musculoskeletal& model, const JointShape& shape);
/// Designs the loops where the model is placed now. Throws as hinges_of and stabilised.
JointLoops joint_loops(Musculoskeletal& model, const JointShape& shape);

/// What loops are worth with the G and A of another posture.
struct LoopCheck {
  double margin;          ///< ε that is left
  double slowest_per_s;   ///< largest real part of the closed loop's poles
  double most_sensitive;  ///< largest singular value of (1 + G K)⁻¹
  std::vector<double>
      crossover_Hz;  ///< where each joint's own loop, the others closed, falls below 1
};
LoopCheck checked(const JointLoops& loops);
/// The same loops where the model is placed now.
JointLoops moved(const JointLoops& loops, Musculoskeletal& model, const JointShape& shape);

}  // namespace sim::loop_shaping
