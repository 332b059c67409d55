#pragma once
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

/// Verbs that command a running robot from a terminal, through its plant. They return exit codes, and
/// throw std::invalid_argument for wrong names and std::runtime_error if no robot is running.
namespace launch {

/// Above the controllers of the shipped graphs (0 to 10); chosen.
inline constexpr int hand_priority = 50;

struct StopOptions {
  std::string robot;  ///< empty: every robot on the bus
  bool release = false;
};
/// Switches all actuators off and keeps them off after the verb has ended, whatever controllers
/// command; or releases them. Returns 0 when the plants of all robots have confirmed it, 1 otherwise.
int stop_robots(const StopOptions& options, std::ostream& out);

struct SendOptions {
  std::string robot;
  std::vector<std::string> actuators;
  std::string mode;  ///< voltage, length, current, force or off
  double reference = 0;
  int priority = hand_priority;
  double for_s = 0;  ///< 0: until Ctrl-C
};
/// Commands actuators and prints their measured values; releases them at the end. Throws
/// std::runtime_error with the owner and its priority if another controller keeps an actuator.
int send_command(const SendOptions& options, std::ostream& out);

struct HomeOptions {
  std::string robot;
  std::vector<std::string> actuators;  ///< empty: those whose zero is unknown
  bool all = false;                    ///< every actuator
  bool here = false;                   ///< the robot is in its starting pose now; without moving it
  double tension_N = 12;               ///< largest tension of a line while homing
  int priority = hand_priority;
  std::string xml;  ///< robot.xml; empty: that of the running plant
};
/// Sets the zeros of encoders. Without `here` it winds the lines gently until the robot rests, and
/// computes their lengths from joint sensors, known lines, tensions and robot.xml; if these do not
/// determine the pose, from six poses (sim/world/homing_estimate.hpp). Throws
/// std::runtime_error with the reason if an actuator is not homed; the actuators are released.
int home_robot(const HomeOptions& options, std::ostream& out);

struct SetOptions {
  std::string robot, actuator;
  std::vector<std::pair<std::string, double>> gains;
  int priority = hand_priority + 1;  ///< so that gains can be set while `erp send` drives
};
/// Changes gains of an actuator's ECU. Returns 0 when the ECU has accepted them. Throws
/// std::runtime_error with the reason if the plant or the ECU refuses them, or without an answer.
int set_gains(const SetOptions& options, std::ostream& out);

}  // namespace launch
