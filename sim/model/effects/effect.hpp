#pragma once
#include <array>
#include <string_view>

/// What an unmodelled effect is: something that real robots have and the nominal model leaves out.
///
/// One effect a file, one line in all.hpp. An effect is a plain struct:
///
///   static constexpr About about     its name, where it sits, what shows it
///   parameters, and `visit`          their neutral values change nothing; v.shape: not fitted
///   one or more seams                functions below, called where the simulator and the diagnosis
///                                    have the quantity in hand
///
/// Seams that change constants, once (`auto&`: structs of interfaces/robot, which are not
/// included):
///   change_motor(motor)  change_actuator(actuator)  change_joint(joint)  change_body(body)
///   change_robot(robot, on)                  acts_besides: those below act as well
/// Seams in the chain of an actuator, each step:
///   voltage_V(V, s)                   at the motor's terminals, from what the ECU applies
///   driver_delay_s()                  after which that acts
///   late_voltage_V(V, s, memory)      which acts then, as a mean over a step
///   resistance_ohm(R, s, memory)      of the winding
///   rotor_Nm(s)                       against winding up, on the motor's own shaft
///   friction_Nm(direction, s)         added to the gearbox's Coulomb friction
///   aged_Nm(s, memory)                the same of what remembers, once a step
///   wound(s, wound, memory)           the line on the spindle
///   path(path, s)                     the length of the tendon's path
///   pull(s, memory)                   added to the tendon's pull
///   motor_side_N(F, s)                the pull that reaches the spindle
/// Seams in a joint:
///   joint_friction_Nm(speed)          added to its Coulomb friction
///   joint_torque(angle)               along its axis
///   bearing_rad(angle, memory)        what its sensor's shaft follows
///   looseness_rad()                   how far that shaft may be off, to and fro together
/// Seams of sensors (`static constexpr Sense sense`) and of the bus:
///   read(value, s, memory)            what the sensor says;   undo(said, s, memory)  its inverse
///   averaged(s)                       share, 0 … 1, in which `undo` gives the mean around a sample
///                                     instead of what was there at its instant
///   command_delay_s(u)  frame_delay_s(u)  loses_command(u)    u: uniform in 0 … 1, anew each time
namespace sim::effects {

/// The part of the chain that an effect belongs to.
enum class Stage { bus, motor, gearbox, spindle, tendon, routing, joint, skeleton, sensor };

/// What `on` names.
enum class Seat { actuator, joint, body, robot };

enum class Sense { shaft, current, tension, joint };

struct About {
  std::string_view type;  ///< in robot.xml and in reports; begins with the stage
  Stage stage;
  Seat seat;
  std::string_view shown_by;  ///< the excitation that shows it
};

/// A parameter's search interval; beyond it robot.xml is refused.
struct Bounds {
  double low, high;
};

/// What an effect remembers from step to step; zero at the start.
using Memory = std::array<double, 8>;

/// One actuator, now: what its seams may look at.
struct ChainSample {
  double dt_s = 0;  ///< since the sample before
  double supply_V = 0, voltage_V = 0;
  double current_A = 0;
  double current_square_A2 = 0;  ///< mean since the sample before
  double gear_ratio = 1;
  double shaft_rad = 0, speed_rad_per_s = 0;  ///< gearbox shaft; positive: winding up
  double radius_m = 0;                        ///< of the spindle
  double tension_N = 0;                       ///< at the distal end
  double load_Nm = 0;                         ///< of the line on the gearbox shaft
  double stretch_m = 0;                       ///< Δx; for `wound`, of the line as nominally wound
  double stiffness_N_per_m = 0;               ///< dF/dΔx there, of the spring
  double path_m = 0, path_change_m = 0;       ///< length of the path, and since the start
  double wrap_rad = 0;                        ///< total bend of the path
  bool pushes = false;                        ///< it is a shaft, not a line
  double line_speed_m_per_s = 0;              ///< over the path, towards the spindle
};

/// A quantity with its derivative: d m/d rad, d m/d m, d N/d m, d Nm/d rad.
struct Sloped {
  double value = 0, slope = 0;
};

/// One sensor, now.
struct SensorSample {
  double time_s = 0, dt_s = 0;
  double turns_per_turn = 1;  ///< the sensor's own shaft to what it measures
  double said_rate = 0;       ///< change of what it says a second, for `undo`
};

}  // namespace sim::effects
