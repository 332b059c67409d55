#pragma once
#include <array>
#include <string_view>

/// Definition of an effect: a property of real robots that the nominal model lacks.
///
/// One file per effect, and one line in all.hpp. An effect is a plain struct:
///
///   static constexpr About about     name, stage, kind of target, and the excitation that shows it
///   parameters, and `visit`          default values change nothing; a parameter that `visit` passes
///                                    to v.shape(…) instead of v(…) is not estimated
///   one or more seams                the functions below; the simulator and the diagnosis call
///                                    them where they compute the quantity
///
/// Seams that change constants, called once (arguments are `auto&`, because the structs of
/// interfaces/robot are not included):
///   change_motor(motor)  change_actuator(actuator)  change_joint(joint)  change_body(body)
///   change_robot(robot, on)                  `on`: name of the target
/// An effect with one of these seams and one of those below declares
///   static constexpr bool acts_per_step = true
/// Seams in the chain of an actuator, called in each step:
///   voltage_V(V, s)                   voltage at the motor for the voltage V that the ECU applies
///   driver_delay_s()                  delay until this voltage acts, for the diagnosis
///   delayed_voltage_V(V, s, memory)   mean of the delayed voltage over a step, for the simulator
///   resistance_ohm(R, s, memory)      of the winding
///   rotor_Nm(s)                       torque against winding up, on the motor's shaft
///   friction_Nm(direction, s)         added to the gearbox's Coulomb friction
///   aged_Nm(s, memory)                also added to that friction, by an effect with memory;
///                                     called once per step
///   wound(s, wound, memory)           length of the line on the spindle
///   path(s, path)                     the length of the tendon's path
///   pull(s, memory)                   added to the tension
///   motor_side_N(F, s)                tension at the spindle
/// Seams in a joint:
///   joint_friction_Nm(speed)          added to the joint's Coulomb friction
///   joint_torque(angle)               torque about the joint's axis
///   sensor_shaft_rad(angle, memory)   angle of the sensor's shaft
///   play_rad()                        total play of that shaft
/// Seams of sensors (`static constexpr Sense sense`) and of the bus:
///   read(value, s, memory)            the reading;   undo(reading, s, memory)  its inverse
///   averaged(s)                       what `undo` returns: 0, the value at the instant of the
///                                     sample; 1, the mean around it; between, a mixture
///   command_delay_s(u)  frame_delay_s(u)  loses_command(u)    u: uniform in 0 … 1, new per call
namespace sim::effects {

/// The stage of the model that an effect belongs to.
enum class Stage { bus, motor, gearbox, spindle, tendon, routing, joint, skeleton, sensor };

/// The kind of target; `on` in robot.xml is its name.
enum class Seat { actuator, joint, body, robot };

enum class Sense { shaft, current, tension, joint };

struct About {
  std::string_view type;  ///< in robot.xml and in reports; begins with the stage
  Stage stage;
  Seat seat;
  std::string_view shown_by;  ///< the excitation that shows it
};

/// A parameter's search interval. Values outside are rejected when robot.xml is read.
struct Bounds {
  double low, high;
};

/// State of an effect between steps; zero at the start.
using Memory = std::array<double, 8>;

/// State of one actuator at the current time, the input of its seams.
struct ChainSample {
  double dt_s = 0;  ///< since the previous sample
  double supply_V = 0, voltage_V = 0;
  double current_A = 0;
  double current_square_A2 = 0;  ///< mean since the previous sample
  double gear_ratio = 1;
  double shaft_rad = 0, speed_rad_per_s = 0;  ///< gearbox shaft; positive: winding up
  double radius_m = 0;                        ///< of the spindle
  double tension_N = 0;                       ///< at the distal end
  double load_Nm = 0;                         ///< torque of the line on the gearbox shaft
  double stretch_m = 0;          ///< Δx; when `wound` is called, from the nominal wound length
  double stiffness_N_per_m = 0;  ///< dF/dΔx of the spring at this stretch
  double path_m = 0, path_change_m = 0;  ///< length of the path, and its change since the start
  double wrap_rad = 0;                   ///< total bend of the path
  bool pushes = false;  ///< the actuator has a rigid rod, which can push, instead of a line
  double line_speed_m_per_s = 0;  ///< along the path, positive towards the spindle
};

/// A quantity and its slope, in m/rad, m/m, N/m or Nm/rad.
struct Sloped {
  double value = 0, slope = 0;
};

/// State of one sensor at the current time.
struct SensorSample {
  double time_s = 0, dt_s = 0;
  double turns_per_turn = 1;  ///< turns of the sensor's shaft per turn of the measured shaft
  double reading_rate = 0;    ///< rate of change of the reading, per s; for `undo`
};

}  // namespace sim::effects
