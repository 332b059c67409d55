#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/robot/actuator.hpp"
#include "interfaces/robot/bus.hpp"
#include "interfaces/robot/drive.hpp"
#include "interfaces/robot/effect.hpp"
#include "interfaces/robot/sensors.hpp"
#include "interfaces/robot/skeleton.hpp"
#include "interfaces/xml/fields.hpp"

/// robot.xml as plain structs. Each struct lists its attributes and children once, in `visit`. The
/// strict reader, the writer and the XSD use that list.
namespace erp {

struct Pretension {
  static constexpr auto element = "pretension";
  static constexpr auto description =
      "Pretension of one tendon, instead of that in its <tendon>, since pretensions must balance "
      "the whole robot; of several for one actuator, the last applies. `erp model balance` "
      "computes them.";
  xml::Place place;
  std::string actuator;
  double tension_N = 0;
  void visit(auto& v) {
    v.required("actuator", actuator, "Name of the actuator.");
    v.required("tension_N", tension_N,
               {xml::at_least_zero, "Tension in the starting pose before the motor turns."});
  }
};

/// `<tolerance of="resistance_ohm" on="flexor" relative="0.1"/>`. sim/gap lists and checks the
/// constants.
struct Tolerance {
  static constexpr auto element = "tolerance";
  static constexpr auto description =
      "Standard deviation of a constant of the built robot from its value in robot.xml, for the "
      "diagnosis and `erp gap calibrate`; simulation and control ignore it. Of several for one "
      "constant, the last applies.";
  xml::Place place;
  std::string of, on;
  std::optional<double> relative, absolute;  ///< exactly one of the two
  void visit(auto& v) {
    v.required(
        "of", of,
        "Name of the constant: an attribute such as resistance_ohm or radius_m, a factor (1 in "
        "robot.xml) on mass, com or inertia of a body, or a sensor error such as tension_gain.");
    v("on", on,
      "Name of an actuator, drive, joint or body. Default: all that have such a constant.");
    v("relative", relative,
      {xml::at_least_zero,
       "Standard deviation relative to the constant; 0: exactly known, not estimated. Give either "
       "relative or absolute."});
    v("absolute", absolute,
      {xml::at_least_zero,
       "Standard deviation in the unit of the constant; required where the constant is 0 in "
       "robot.xml. 0: exactly known, not estimated."});
  }
};

struct Include {
  static constexpr auto element = "include";
  static constexpr auto description =
      "Another robot.xml, whose elements are added to this robot. The name of that robot is "
      "ignored.";
  xml::Place place;
  std::string file;
  int ecu_offset = 0;
  void visit(auto& v) {
    v.required("file", file, "Path of the file, relative to the file that contains this element.");
    v("ecu_offset", ecu_offset,
      {xml::Range{-127, 127}, "Number that is added to every ECU address of the file."});
  }
};

struct Mirror {
  static constexpr auto element = "mirror";
  static constexpr auto description =
      "Another robot.xml, reflected at its plane y = 0 and added to this robot, such as a left arm "
      "as a right one. Equal joint angles are mirror images.";
  xml::Place place;
  std::string file;
  std::string from, to;  ///< "left_", "right_"
  int ecu_offset = 0;
  void visit(auto& v) {
    v.required("file", file, "Path of the file, relative to the file that contains this element.");
    v.required("from", from,
               "Prefix of the names and references that are renamed. Names without it refer to "
               "elements of other files.");
    v.required("to", to, "Prefix that replaces from.");
    v("ecu_offset", ecu_offset,
      {xml::Range{-127, 127}, "Number that is added to every ECU address of the file."});
  }
};

/// Where the robot is when its ECUs are switched on; their encoders then count from 0.
enum class SwitchedOn { anywhere, starting_pose };
/// When unknown zeros of encoders are set by moving the robot.
enum class Homing { on_command, at_start };

/// A robot. `read_robot` applies includes, mirrors and pretensions; their lists are then empty.
struct Robot {
  static constexpr auto element = "robot";
  static constexpr auto description =
      "Robot with tendons or drives, or a part of one that another file includes.";
  xml::Place place;
  std::string name;
  SwitchedOn switched_on = SwitchedOn::anywhere;
  Homing homing = Homing::on_command;
  std::vector<Skeleton> skeletons;  ///< one per part; `bodies()` and `joints()` combine them
  std::vector<MotorType> motor_types;
  std::vector<SensorType> sensor_types;
  std::vector<Actuator> actuators;
  std::vector<Drive> drives;  ///< drives without tendons; for diagnosis only, not on the bus
  std::vector<JointSensor> joint_sensors;
  std::vector<Potentiometer> potentiometers;
  std::vector<Imu> imus;
  std::vector<BusPlan> can_buses;  ///< as in the file; `buses()` is never empty
  std::vector<Effect> effects;
  std::vector<Tolerance> tolerances;    ///< the last one for a constant applies
  std::vector<Pretension> pretensions;  ///< the last one for an actuator applies
  std::vector<Include> includes;
  std::vector<Mirror> mirrors;
  void visit(auto& v) {
    v.required("name", name,
               "Name of the robot; key of its messages on the bus. Effects on the whole robot "
               "refer to it.");
    v("switched_on", switched_on,
      "Where the robot is whenever its ECUs are switched on. starting_pose: always in its starting "
      "pose, with all lines as long as in robot.xml; the plant sets the zeros of the encoders "
      "there, "
      "if the joint sensors agree within 0.052 rad. anywhere: the zeros are unknown until a "
      "potentiometer or `erp home` sets them, and length references are refused. Of an included "
      "file it is ignored.");
    v("homing", homing,
      "at_start: `erp launch` runs `erp home` once all components are active, which moves the "
      "robot "
      "if a zero is unknown. on_command: only a person runs it. Of an included file it is "
      "ignored.");
    v.list(includes);
    v.list(mirrors);
    v.list(skeletons);
    v.list(motor_types);
    v.list(sensor_types);
    v.list(actuators);
    v.list(drives);
    v.list(joint_sensors);
    v.list(potentiometers);
    v.list(imus);
    v.list(can_buses);
    v.list(effects);
    v.list(tolerances);
    v.list(pretensions);
  }

  std::vector<Body> bodies() const;  ///< of all skeletons, in the order of the file
  std::vector<Joint> joints() const;
  /// The inputs of the joint sensors, then of the potentiometers.
  std::vector<AnalogInput> analog_inputs() const;
  /// ECU addresses in use, ascending.
  std::vector<int> ecus() const;
  /// The CAN buses in the order of the file; if there are none, one bus with every ECU.
  std::vector<BusPlan> buses() const;
  Vec3 gravity_m_per_s2() const;  ///< zero if no part defines it
  /// The types of an actuator. Throw std::out_of_range if the robot does not contain them;
  /// read_robot rejects such a robot.
  const MotorType& motor_of(const Actuator& actuator) const;
  const SensorType& sensors_of(const Actuator& actuator) const;
};

/// Reads robot.xml with its includes and mirrors, and checks it with `check_robot`.
/// Throws xml::Errors with all errors: place, value, remedy.
Robot read_robot(const std::string& file);

/// The robot as one robot.xml without includes; it reads back bit-equal.
std::string write_robot(const Robot& robot);

}  // namespace erp

template <>
struct xml::Names<erp::Homing> {
  static constexpr auto list = std::to_array<std::pair<const char*, erp::Homing>>(
      {{"on_command", erp::Homing::on_command}, {"at_start", erp::Homing::at_start}});
};

template <>
struct xml::Names<erp::SwitchedOn> {
  static constexpr auto list = std::to_array<std::pair<const char*, erp::SwitchedOn>>(
      {{"anywhere", erp::SwitchedOn::anywhere}, {"starting_pose", erp::SwitchedOn::starting_pose}});
};
