#pragma once
#include <array>
#include <string>

#include "components/puller_follower/antagonists.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/topics.hpp"
#include "sim/control/loop_shaping/joint_loops.hpp"
#include "sim/model/actuator/musculoskeletal.hpp"

/// Drives a hinge's two tendons so that they apply a torque: step 2 of puller-follower control
/// (paper, 5.2 and Fig. 7a).
namespace control {

/// Reference tension of a pair, and dynamics of the tensions; described in PullerFollower::Params.
struct DriveParams {
  double low_N = 4, high_N = 15;
  double width_Nm = 0.15;
  double lead_s = 0.3;
  double raise_N_per_s = 40;
  double raise_s = 0.05;
  double smooth_s = 0.01;
  double tension_per_s = 60;
  double brake_s = 0.05;
};

class JointDrive {
 public:
  /// Throws std::invalid_argument unless the hinge has exactly two antagonists that turn no other
  /// joint.
  JointDrive(const erp::Robot& robot, const sim::Musculoskeletal& model,
             const sim::loop_shaping::Hinge& hinge, const DriveParams& params);

  /// False: tension or shaft angle of a tendon is not known.
  bool read_sensors(const erp::SensorFrame& frame, double dt_s);
  /// True if one of the tendons has been slack for more than 16 ms.
  bool is_slack() const;
  /// Torque that the tendons apply now.
  double torque_Nm(const sim::Musculoskeletal& model) const;
  /// Starts at this torque and at the current smaller tension.
  void begin(double torque_Nm);
  /// Adds both voltages to the command. `acceleration`: of the joint under this torque, in rad/s².
  void drive(double torque_Nm, double acceleration, const sim::Musculoskeletal& model, double dt_s,
             erp::ActuatorCommand& command);

  /// True if the commanded voltage exceeded the supply for much of the last second. A closed loop
  /// with saturated motors oscillates.
  bool is_saturated() const { return saturation_ > saturation_limit; }
  /// Braking: the lines keep their current length, plus damping that slow motors can apply.
  ///
  ///   line = line₀ − g dl/dt
  void stop();  ///< stores the current line lengths as line₀
  void brake(const sim::Musculoskeletal& model, erp::ActuatorCommand& command) const;

 private:
  /// Chosen: attaching a load of 0.2 kg stays below it.
  static constexpr double saturation_limit = 0.4;

  struct Tendon {
    std::size_t actuator;
    std::string name;
    double supply_V, max_N;
    TensionLinearisation law;
    double tension_N = 0, shaft_rad = 0, speed_rad_per_s = 0, slack_s = 0;
    double line_m = 0, brake_line_m = 0;
    bool is_measured = false;
  };
  /// A signal and its smoothed derivatives.
  struct Smooth {
    double value = 0, rate = 0, acceleration = 0;
    void smooth(double target, double dt_s, double smooth_s);
  };
  double lever_m(const Tendon& tendon, const sim::Musculoskeletal& model) const {
    return model.jacobian()(static_cast<Eigen::Index>(tendon.actuator), coordinate_);
  }
  Tendon tendon_of(const erp::Robot& robot, std::size_t actuator) const;
  void update_references(double torque_Nm, double dt_s);
  /// True if the voltage is within the supply. `tension_per_torque`: dF_d/dτ, in 1/m.
  bool command(std::size_t index, double tension_N, double tension_per_torque, double speed,
               double lever_m, double acceleration, erp::ActuatorCommand& command) const;

  DriveParams params_;
  int coordinate_;
  std::array<Tendon, 2> tendons_;  ///< [0] pulls towards positive angles
  Smooth torque_, reference_;
  double target_N_ = 0;
  double saturation_ = 0;  ///< fraction of the last second with saturated motors
};

}  // namespace control
