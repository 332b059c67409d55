#pragma once
#include <span>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/gap/blind/hidden_effects.hpp"
#include "sim/model/actuator/muscle_jacobian.hpp"

/// The robot of a blind case in continuous time: ordinary differential equations, integrated by the classical
/// Runge–Kutta method of order four at a small step. Independent of the simulator and of the library of
/// effects, so that the diagnosis cannot succeed by sharing their equations:
///
/// - friction: one bristle per contact, ṡ = (ω − |ω| s / g(ω))/δ, torque τ (s + b ṡ)  (Dahl, LuGre)
/// - gear: X/e with e = η^(s sgn X), continuous through standstill
/// - backlash: two masses and a dead zone; shaft: two masses and a spring
/// - hysteresis: three sliding elements (Iwan); creep: a Maxwell element
/// - stops: springs and dampers
///
/// Shared with the simulator: the nominal bones (sim/model/skeleton: H, C, τ_G) and the paths of the tendons.
namespace sim::blind {

class Plant {
 public:
  Plant(const erp::Robot& nominal, const HiddenEffects& hidden_effects);

  /// Advances by `duration_s` with constant voltages. Returns false if the motion is not finite.
  bool run(std::span<const double> voltage_V, double duration_s, double gust);

  double time_s() const { return time_s_; }
  // Inputs of the sensors, including lag and play.
  double shaft_rad(std::size_t actuator) const;
  double current_A(std::size_t actuator) const;
  double tension_N(std::size_t actuator) const;
  double angle_rad(std::size_t joint) const;
  /// w x y z of a spherical joint.
  std::array<double, 4> quaternion(std::size_t joint) const;
  const std::vector<erp::Joint>& joint_list() const { return tree_.joints; }

 private:
  using State = std::vector<double>;
  struct Chain {
    erp::MotorType motor;
    ChainEffects q;
    Routing routing;
    Levers levers;
    PathShape shape;
    double start_m = 0, rest_m = 0, radius_m = 0, spring = 0, cubic = 0, damping = 0, line = 0;
    bool two_masses = false;
    Eigen::VectorXd row;
  };
  struct Line {
    double tension_N, path_slope, motor_side_N, wound_slope, bend_rad;
  };
  Chain chain_of(const erp::Robot& nominal, std::size_t actuator, const ChainEffects& q);
  double stretch_at(const Chain& chain, double pull_N) const;
  void start(const erp::Robot& nominal);
  void derive(const State& x, std::span<const double> voltage_V, double gust, State& dx);
  Line pull(Chain& chain, const double* x, double path_rate, double* dx) const;
  void turn(const Chain& chain, const double* x, const Line& line, double voltage_V,
            double* dx) const;
  void lag(const Chain& chain, const double* x, const Line& line, double* dx) const;
  void move_bones(const State& x, const Eigen::VectorXd& torque, double gust, State& dx);
  void read_joints(const State& x);
  double spring_N(const Chain& chain, double stretch_m) const;

  RobotTree tree_;
  SkeletonModel model_;
  std::vector<Chain> chains_;
  std::vector<JointEffects> joint_effects_;
  std::vector<JointReading> joints_;
  State x_;
  std::vector<double> tension_N_;
  double time_s_ = 0, most_step_s_;
  Eigen::MatrixXd inertia_;
  Eigen::VectorXd bias_;
};

/// The robot with other masses, a tilted base and flexible bones: effects that a description can express.
erp::Robot changed(const erp::Robot& nominal, const HiddenEffects& hidden_effects);

}  // namespace sim::blind
