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

/// A robot, simulated: bones in Bullet, tendons over them, motors at their ends.
///
/// One step from t to t + dt (paper, 4.2): tensions, joint friction and stops follow from the
/// motion they cause together (step_solver.hpp: stable for any stiffness); the tensions load the
/// motors, which move exactly with V and F held; Bullet moves the bones. First order in dt.
///
///   H v¹ = H v − dt b(q, v) + impulses            b = C + τ_G
///   H v⁺ = H v − dt b(q, (v + v¹)/2) + impulses   velocity-dependent forces at mid-step
///
/// v⁺ = v¹ would feed energy into ball joints: 7 J in 10 s into the free arm at 1 ms, against 0.07
/// J.
///
/// The robot's effects (sim/model/effects) act in its chains and joints, each held over a step.
///
/// Tendons that are ropes (rope.hpp) follow the bones: their forces act over the next step.
///
/// Same robot, options and voltages: bit-identical readings. No clock, no heap in `step`.
namespace sim {

struct WorldOptions {
  std::vector<std::string> lock;  ///< joints held at their initial angle
  double usual_step_s = 0.001;    ///< other dt work too, more slowly
  double theta = 0;               ///< of the tendons, ½ … 1; 0: each step chooses
};

struct ActuatorReading {
  double tension_N = 0;  ///< of the tendon, at this instant as all others
  double length_m = 0;   ///< of the tendon's path
  double current_A = 0, speed_rad_per_s = 0, shaft_rad = 0;
  double line_m = 0;  ///< change since the start; negative: wound up
};

/// Something held, of no size: `body` an index of `World::body_names`, the place in its frame.
struct Carried {
  int body = 0;
  Vec3 at_m = Vec3::Zero();
  double mass_kg = 0;
};

/// All that a world's future depends on.
struct WorldState {
  double time_s = 0, time_rest_s = 0;  ///< the rest: what adding up has rounded away
  std::vector<JointReading> joints;
  std::vector<MotorState> motors;
  std::vector<double> tension_N;
  std::vector<std::array<double, max_path_elements>> around_rad;  ///< how far round its pulleys
  std::vector<RopeState> ropes;                                   ///< of the tendons that are ropes
  std::vector<effects::Memory> effects;                           ///< what they remember
  std::vector<bool> snapped;                                      ///< tendons that pull no more
  std::vector<Carried> carried;
};

class World {
 public:
  /// Throws std::invalid_argument for a robot that cannot be simulated: see effects::equip,
  /// RobotTree, Routing, Motor; and for a point inside a pulley, with the actuator's name.
  explicit World(const erp::Robot& robot, const WorldOptions& options = {});
  ~World();

  /// One voltage an actuator, in robot.xml's order; std::invalid_argument otherwise.
  void step(std::span<const double> voltage_V, double dt_s);
  /// The same with given tensions in place of motors and springs, which stay as they are.
  void step_pulled(std::span<const double> tension_N, double dt_s);
  /// Builds everything anew: the start, exactly.
  void reset();
  /// A world of the same robot and options goes on from there bit by bit as the one that was saved.
  WorldState save() const;
  void restore(const WorldState& state);
  /// Breaks a tendon: it pulls no more, until `reset`. Not for ropes.
  void snap(std::size_t actuator) { chains_[actuator].snapped = true; }
  /// From now on the bodies carry this beside their own mass, and nothing else; until `reset`.
  /// Throws std::invalid_argument for a body that no hinge or ball joint moves.
  void carry(std::vector<Carried> carried);
  /// Puts a joint elsewhere, at rest or moving; lines and motors stay as they are. Ropes are laid
  /// anew.
  void set_joint(int joint, const JointReading& reading);

  /// Joint positions and velocities, and where the bodies are; source "sim". Stamps are not set.
  void fill(erp::JointState& joints) const;
  void fill(erp::BodyPose& bodies) const;

  /// With what its effects have changed.
  const erp::Robot& robot() const { return robot_; }
  double time_s() const { return time_s_; }
  std::span<const ActuatorReading> actuators() const { return readings_; }
  std::span<const JointReading> joints() const { return bones_->joints(); }
  std::span<const BodyPose> poses() const { return model_->poses(); }
  std::span<const BodyTwist> twists() const { return model_->twists(); }
  const std::vector<std::string>& body_names() const { return tree_.names; }
  const std::vector<erp::Joint>& joint_list() const { return tree_.joints; }
  const PathShape& path(int actuator) const { return chains_[actuator].shape; }
  /// Steps whose forces did not settle; their velocities are near the answer.
  long unsettled() const { return unsettled_; }
  /// False: a step led to no finite velocities; since then nothing moves.
  bool sound() const { return sound_; }
  /// Null: this tendon is no rope.
  const Rope* rope(int actuator) const { return chains_[actuator].rope.get(); }
  /// Of the bones: kinetic and potential.
  double energy_J() const { return model_->energy_J(); }

 private:
  struct Chain {
    Motor motor;
    Routing routing;
    Levers levers;
    TendonLaw tendon;
    MotorState state;
    PathShape shape;
    std::unique_ptr<Rope> rope;  ///< null: a tendon that finds its path at once
    effects::Acting effects;
    effects::Sloped wound;  ///< line on the spindle, m and m/rad
    double start_m = 0;     ///< length of the path
    double cold_ohm = 0;    ///< the winding's resistance at the start
    bool snapped = false;
    bool has_rope() const { return rope != nullptr; }
  };
  struct JointEffects {
    int joint, first, dofs;
    std::size_t friction;  ///< its place among the solver's
    double coulomb_Nm;     ///< without effects
    effects::Acting acting;
  };
  /// A tendon with its effects, at the start of a step.
  struct Line {
    double stretch_m, path_slope;
    effects::Sloped pull;
  };
  Chain make_chain(const erp::Actuator& actuator) const;
  void make_solver();
  void read();
  /// By the tendon's law, of where bones and shaft are now; the force over a step is older.
  double tension_now_N(std::size_t chain);
  void read_tensions();
  void find_forces(double dt_s, bool springs);
  void move(double dt_s);
  void make_ropes();
  void lay_rope(std::size_t chain, std::optional<double> pretension_N);
  void pass_time(double dt_s);
  void add_rope_impulses(double dt_s);
  void move_ropes(double dt_s);
  void pull(std::size_t chain, double dt_s);
  effects::ChainSample sample(std::size_t chain, double dt_s) const;
  Line line_of(std::size_t chain, double dt_s);
  void heat(Chain& chain, double ohm) const;
  void restore_effects(Chain& chain, std::span<const effects::Memory>& memories) const;
  void affect_joints();
  Eigen::VectorXd torque_of(JointEffects& joint) const;
  void turn_motor(std::size_t chain, double voltage_V, double tension_N, double dt_s);
  void expect(std::span<const double> inputs, const char* what) const;
  void solve(double dt_s, std::span<const double> tension_N = {});
  void drive(double dt_s);

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
  std::vector<Carried> carried_;
  double time_s_ = 0, time_rest_s_ = 0;
  long unsettled_ = 0;
  bool sound_ = true;

  // what a step works with
  std::vector<OneSidedForce> forces_;  ///< of the tendons, the stops, the contacts
  std::size_t force_count_ = 0;
  Eigen::MatrixXd inertia_;                                             ///< H
  Eigen::VectorXd row_, bias_, momentum_, driven_, velocity_, middle_;  ///< J of one tendon, b …
  EnvelopeCholesky inertia_factor_;
};

}  // namespace sim
