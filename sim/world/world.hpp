#pragma once
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interfaces/topics.hpp"
#include "sim/model/actuator/motor.hpp"
#include "sim/model/actuator/muscle_jacobian.hpp"
#include "sim/model/actuator/rope.hpp"
#include "sim/model/actuator/routing.hpp"
#include "sim/model/actuator/tendon.hpp"
#include "sim/model/effects/acting.hpp"
#include "sim/model/skeleton/skeleton_model.hpp"
#include "sim/world/bullet_skeleton.hpp"
#include "sim/world/contacts.hpp"
#include "sim/world/implicit_tendon.hpp"
#include "sim/world/joint_limits.hpp"
#include "sim/world/step_solver.hpp"

namespace sim::effects {
struct Equipped;
}

/// A simulated robot: bodies in Bullet, tendons between them, motors at their ends.
///
/// One step from t to t + dt (paper, 4.2). Tensions, joint friction and joint limits are computed
/// together with the motion that they cause (step_solver.hpp: stable for any stiffness). The
/// tensions load the motors, whose motion is exact for constant V and F. Bullet moves the bodies.
/// First order in dt.
///
///   H v¹ = H v − dt b(q, v) + impulses            b = C + τ_G
///   H v⁺ = H v − dt b(q, (v + v¹)/2) + impulses   velocity-dependent forces at mid-step
///
/// v⁺ = v¹ would add energy to ball joints: 7 J to the free arm in 10 s at 1 ms, instead of 0.07 J.
///
/// The robot's effects (sim/model/effects) act in its chains and joints, each constant over a step.
///
/// Tendons modelled as ropes (rope.hpp) follow the bodies: their forces act over the next step.
///
/// Equal robots, options and voltages give bit-identical readings. No clock, no heap in `step`.
namespace sim {

struct WorldOptions {
  std::vector<std::string> lock;  ///< joints fixed at their initial angle
  double usual_step_s = 0.001;    ///< dt of most steps; a step with another dt takes longer
  double theta = 0;               ///< θ of the tendons, ½ … 1; 0: chosen at each step
};

struct ActuatorReading {
  double tension_N = 0;  ///< of the tendon, at the instant of the other readings
  double length_m = 0;   ///< of the tendon's path
  double current_A = 0, speed_rad_per_s = 0, shaft_rad = 0;
  double line_m = 0;  ///< change of line length since the start; negative: wound up
};

/// A point mass attached to a body: `body` indexes `World::body_names`, the position is in its
/// frame.
struct AttachedMass {
  int body = 0;
  Vec3 at_m = Vec3::Zero();
  double mass_kg = 0;
};

/// The complete state of a world.
struct WorldState {
  double time_s = 0, time_remainder_s = 0;  ///< rounding error of the sum
  std::vector<JointReading> joints;
  std::vector<MotorState> motors;
  std::vector<double> tension_N;
  std::vector<std::array<double, max_path_elements>>
      around_rad;                        ///< wrap angles around its pulleys
  std::vector<RopeState> ropes;          ///< of the tendons modelled as ropes
  std::vector<effects::Memory> effects;  ///< memory of the effects
  std::vector<bool> snapped;             ///< tendons that have snapped
  std::vector<AttachedMass> attached;
};

class World {
 public:
  /// Throws std::invalid_argument for a robot that cannot be simulated: see effects::equip,
  /// RobotTree, Routing, Motor; and for a point inside a pulley, with the actuator's name.
  explicit World(const erp::Robot& robot, const WorldOptions& options = {});
  ~World();

  /// One voltage per actuator, in robot.xml's order; std::invalid_argument for another number.
  void step(std::span<const double> voltage_V, double dt_s);
  /// A step with given tensions. The motors and the springs do not change.
  void step_pulled(std::span<const double> tension_N, double dt_s);
  /// Restores exactly the initial state.
  void reset();
  /// A restored world of the same robot and options continues bit by bit like the saved one.
  WorldState save() const;
  void restore(const WorldState& state);
  /// Snaps a tendon: it exerts no tension until `reset`. Not for ropes.
  void snap(std::size_t actuator) { chains_[actuator].snapped = true; }
  /// Replaces the masses attached to the bodies, until `reset`. Throws std::invalid_argument for a
  /// body that no hinge or ball joint moves.
  void attach(std::vector<AttachedMass> attached);
  /// Sets position and velocity of a joint; line lengths and motors do not change. Ropes are placed
  /// along their paths again.
  void set_joint(int joint, const JointReading& reading);

  /// Joint positions and velocities, and body poses; source "sim". Does not set the stamps.
  void fill(erp::JointState& joints) const;
  void fill(erp::BodyPose& bodies) const;

  /// The robot, including the changes of its effects.
  const erp::Robot& robot() const { return robot_; }
  double time_s() const { return time_s_; }
  std::span<const ActuatorReading> actuators() const { return readings_; }
  std::span<const JointReading> joints() const { return bones_->joints(); }
  std::span<const BodyPose> poses() const { return model_->poses(); }
  std::span<const BodyTwist> twists() const { return model_->twists(); }
  const std::vector<std::string>& body_names() const { return tree_.names; }
  const std::vector<erp::Joint>& joint_list() const { return tree_.joints; }
  const PathShape& path(int actuator) const { return chains_[actuator].shape; }
  /// Number of steps whose forces did not converge; their velocities are close to the solution.
  long unconverged_steps() const { return unconverged_steps_; }
  /// False: a step gave velocities that are not finite; nothing has moved since.
  bool is_finite() const { return finite_; }
  /// Null: this tendon is not modelled as a rope.
  const Rope* rope(int actuator) const { return chains_[actuator].rope.get(); }
  /// Kinetic and potential energy of the bodies.
  double energy_J() const { return model_->energy_J(); }

 private:
  struct Chain {
    Motor motor;
    Routing routing;
    Levers levers;
    TendonLaw tendon;
    MotorState state;
    PathShape shape;
    std::unique_ptr<Rope> rope;  ///< null: tendon without rope dynamics
    effects::Acting effects;
    effects::Sloped wound;  ///< line on the spindle, m and m/rad
    double start_m = 0;     ///< length of the path
    double cold_ohm = 0;    ///< the winding's resistance at the start
    bool snapped = false;
    bool has_rope() const { return rope != nullptr; }
  };
  struct JointEffects {
    int joint, first, dofs;
    std::size_t friction;  ///< index in the solver
    double coulomb_Nm;     ///< without effects
    effects::Acting acting;
  };
  /// A tendon with its effects, at the start of a step.
  struct LineState {
    double stretch_m, path_slope;
    effects::Sloped effects_pull;  ///< added to the tension, N and N/m
  };
  Chain make_chain(const erp::Actuator& actuator) const;
  void make_solver();
  void read();
  /// Tension from the tendon's law at the current positions; the solver's forces hold for a whole
  /// step.
  double current_tension_N(std::size_t chain);
  void read_tensions();
  void find_forces(double dt_s, bool springs);
  void move(double dt_s);
  void make_ropes();
  void lay_rope(std::size_t chain, std::optional<double> pretension_N);
  void advance_time(double dt_s);
  void add_rope_impulses(double dt_s);
  void move_ropes(double dt_s);
  void set_tendon_force(std::size_t chain, double dt_s);
  effects::ChainSample sample(std::size_t chain, double dt_s) const;
  LineState line_state(std::size_t chain, double dt_s);
  void set_winding_resistance(Chain& chain, double ohm) const;
  void restore_effects(Chain& chain, std::span<const effects::Memory>& memories) const;
  void set_joint_friction();
  Eigen::VectorXd torque_of(JointEffects& joint) const;
  void turn_motor(std::size_t chain, double voltage_V, double tension_N, double dt_s);
  void check_size(std::span<const double> inputs, const char* what) const;
  void solve(double dt_s, std::span<const double> tension_N = {});
  void apply_bias(double dt_s);

  std::shared_ptr<const effects::Equipped> equipped_;
  erp::Robot robot_;
  WorldOptions options_;
  RobotTree tree_;
  std::unique_ptr<BulletSkeleton> bones_;
  std::unique_ptr<SkeletonModel> model_;
  std::unique_ptr<JointLimits> limits_;
  std::unique_ptr<Contacts> contacts_;
  std::unique_ptr<StepSolver> solver_;
  std::vector<Chain> chains_;
  std::vector<JointEffects> joint_effects_;
  std::vector<ActuatorReading> readings_;
  std::vector<AttachedMass> attached_;
  double time_s_ = 0, time_remainder_s_ = 0;
  long unconverged_steps_ = 0;
  bool finite_ = true;

  // working memory of a step
  std::vector<OneSidedForce> forces_;  ///< of tendons, joint limits and contacts
  std::size_t force_count_ = 0;
  Eigen::MatrixXd inertia_;  ///< H
  Eigen::VectorXd row_, bias_, momentum_, right_side_, velocity_,
      mid_velocity_;  ///< J of one tendon, b …
  EnvelopeCholesky inertia_factor_;
};

}  // namespace sim
