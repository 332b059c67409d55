#pragma once
#include <span>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/gap/blind/hidden_effects.hpp"
#include "sim/model/actuator/muscle_jacobian.hpp"

/// The robot of a blind case in continuous time: ordinary differential equations, integrated by the
/// classical Runge–Kutta method of order four at a small step. The equations differ from those of
/// the simulator and of the library of effects. Otherwise the diagnosis would be tested with its
/// own equations.
///
/// - friction: one bristle of deflection s and travel δ per contact, ṡ = (ω − |ω| s)/δ,
///   torque τ_c(ω) (s + b ṡ)  (Dahl, LuGre)
/// - gearbox of efficiency η with output torque X: input torque X/e, e = η^(s sgn X), continuous at
///   standstill
/// - backlash: two masses and a dead zone; shaft: two masses and a spring
/// - hysteresis: three sliding elements (Iwan); creep: a Maxwell element
/// - stops: springs and dampers
///
/// Shared with the simulator: the nominal bones (sim/model/skeleton: H, C, τ_G) and the paths of
/// the tendons.
namespace sim::blind {

class Plant {
 public:
  Plant(const erp::Robot& nominal, const HiddenEffects& hidden_effects);

  /// Advances by `duration_s` with constant voltages, one per actuator. `gust`: random torque of
  /// the joints in standard deviations. Returns false if the motion is not finite.
  bool run(std::span<const double> voltage_V, double duration_s, double gust);

  double time_s() const { return time_s_; }
  // Inputs of the sensors, after their low-pass and play.
  double shaft_rad(std::size_t actuator) const;
  double current_A(std::size_t actuator) const;
  double tension_N(std::size_t actuator) const;
  double angle_rad(std::size_t joint) const;
  /// Orientation of a spherical joint, w x y z.
  std::array<double, 4> quaternion(std::size_t joint) const;
  const std::vector<erp::Joint>& joint_list() const { return tree_.joints; }

 private:
  using State = std::vector<double>;
  struct Channel {
    erp::MotorType motor;
    ChannelEffects q;
    Routing routing;
    Levers levers;
    PathShape shape;
    double initial_length_m = 0, rest_length_m = 0, radius_m = 0;
    double spring_N_per_m = 0, cubic_N_per_m3 = 0, damping_N_s_per_m = 0, line_m_per_N = 0;
    bool two_masses = false;      ///< motor and spindle are separate masses
    Eigen::VectorXd moment_arms;  ///< ∂L/∂q
  };
  /// `path_slope`: actual over nominal change of the path's length. `wound_slope_m`: wound length
  /// per angle of the spindle.
  struct Line {
    double tension_N, path_slope, motor_side_N, wound_slope_m;
  };
  Channel channel_of(const erp::Robot& nominal, std::size_t actuator, const ChannelEffects& q);
  double stretch_at(const Channel& channel, double force_N) const;
  void set_initial_state(const erp::Robot& nominal);
  void derivative(const State& x, std::span<const double> voltage_V, double gust, State& dx);
  Line pull_tendon(Channel& channel, const double* x, double path_rate, double* dx) const;
  void turn_motor(const Channel& channel, const double* x, const Line& line, double voltage_V,
                  double* dx) const;
  void filter_readings(const Channel& channel, const double* x, const Line& line, double* dx) const;
  void move_bones(const State& x, const Eigen::VectorXd& torque, double gust, State& dx);
  void read_joints(const State& x);
  double spring_N(const Channel& channel, double stretch_m) const;

  RobotTree tree_;
  SkeletonModel model_;
  std::vector<Channel> channels_;
  std::vector<JointEffects> joint_effects_;
  std::vector<JointReading> joints_;
  State x_;
  std::vector<double> tension_N_;
  double time_s_ = 0, max_step_s_;
  Eigen::MatrixXd inertia_;
  Eigen::VectorXd bias_;
};

/// The robot with other masses, a tilted base and flexible bones: effects that robot.xml can
/// express.
erp::Robot changed(const erp::Robot& nominal, const HiddenEffects& hidden_effects);

}  // namespace sim::blind
