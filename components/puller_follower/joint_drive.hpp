#pragma once
#include <array>
#include <string>

#include "components/puller_follower/antagonists.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/topics.hpp"
#include "sim/model/actuator/musculoskeletal.hpp"
#include "sim/control/loop_shaping/joint_loops.hpp"

/// A hinge's two tendons, driven so that they give a torque: the second step of puller-follower
/// control (paper, 5.2 and Fig. 7a).
namespace control {

/// How taut a pair is kept, and how fast tensions follow.
struct DriveParams {
  double low_N = 4, high_N = 15;  ///< reference tension away from and at a change of roles; chosen
  double width_Nm = 0.15;         ///< of the torque, around a change; chosen
  double lead_s = 0.3;            ///< how long before the change; chosen
  double raise_N_per_s = 40;      ///< how fast it rises and falls: the line that takes; chosen
  double raise_s = 0.05;          ///< how gently that begins and ends; chosen
  double smooth_s = 0.01;         ///< of the torque; chosen
  double tension_per_s = 60;      ///< b of the tensions; chosen
  double brake_s = 0.05;          ///< g of the brake; chosen
};

class JointDrive {
 public:
  /// Throws std::invalid_argument where the hinge has not exactly two antagonists that turn no
  /// other joint.
  JointDrive(const erp::Robot& robot, const sim::Musculoskeletal& model,
             const sim::loop_shaping::Hinge& hinge, const DriveParams& params);

  /// False: tension or shaft of a tendon is not known.
  bool hear(const erp::SensorFrame& frame, double dt_s);
  /// One of its tendons has been slack for longer than a follower may let go.
  bool hangs() const;
  /// What its tendons give now.
  double torque_Nm(const sim::Musculoskeletal& model) const;
  /// From that torque, and as taut as it is.
  void begin(double torque_Nm);
  /// Adds both voltages. `acceleration`: that of the joint under this torque, rad/s².
  void drive(double torque_Nm, double acceleration, const sim::Musculoskeletal& model, double dt_s,
             erp::ActuatorCommand& command);

  /// Its motors were asked for more than their supply for much of the last second: it has outrun
  /// them, and a loop around motors that cannot follow swings.
  bool outrun() const { return strain_ > 0.4; }  // chosen: a catch of 0.2 kg stays below
  /// Its lines stay where they are now, but give and take as the joint moves: damping that slow
  /// motors can give.
  ///
  ///   line = line₀ − g dl/dt
  void stop();
  void brake(const sim::Musculoskeletal& model, erp::ActuatorCommand& command) const;

 private:
  struct Tendon {
    std::size_t actuator;
    std::string name;
    double supply_V, most_N;
    TensionLinearisation law;
    double tension_N = 0, shaft_rad = 0, speed_rad_per_s = 0, slack_s = 0;
    double line_m = 0, stopped_m = 0;
    bool seen = false;
  };
  /// A signal and its smoothed derivatives.
  struct Smooth {
    double value = 0, rate = 0, acceleration = 0;
    void follow(double to, double dt_s, double smooth_s);
  };
  double lever_m(const Tendon& tendon, const sim::Musculoskeletal& model) const {
    return model.jacobian()(static_cast<Eigen::Index>(tendon.actuator), coordinate_);
  }
  Tendon tendon_of(const erp::Robot& robot, std::size_t actuator) const;
  void follow(double torque_Nm, double dt_s);
  /// True: within the supply.
  bool command(std::size_t which, double tension_N, double share, double speed, double lever_m,
               double acceleration, erp::ActuatorCommand& command) const;

  DriveParams params_;
  int coordinate_;
  std::array<Tendon, 2> tendons_;  ///< [0] pulls towards positive angles
  Smooth torque_, reference_;
  double raised_N_ = 0;
  double strain_ = 0;  ///< share of the last second
};

}  // namespace control
