#pragma once
#include <optional>
#include <string>
#include <vector>

#include "interfaces/robot/actuator.hpp"
#include "interfaces/robot/bus.hpp"
#include "interfaces/robot/drive.hpp"
#include "interfaces/robot/effect.hpp"
#include "interfaces/robot/sensors.hpp"
#include "interfaces/robot/skeleton.hpp"
#include "interfaces/xml/fields.hpp"

/// robot.xml as plain structs. Each struct lists its attributes and children once, in `visit`:
/// from that list come the strict reader, the writer and the XSD.
namespace erp {

/// The pretension of a tendon in this robot's starting pose, in place of the one its part gives:
/// pretensions balance a whole robot. `erp model balance` finds them.
struct Pretension {
  static constexpr auto element = "pretension";
  xml::Place place;
  std::string actuator;
  double tension_N = 0;
  void visit(auto& v) {
    v.required("actuator", actuator);
    v.required("tension_N", tension_N, xml::at_least_zero);
  }
};

/// The standard deviation of a number of the robot as built from its value in robot.xml:
/// `<tolerance of="resistance_ohm" on="flexor" relative="0.1"/>`. The numbers are listed and checked in
/// sim/gap. Simulation and control ignore tolerances.
struct Tolerance {
  static constexpr auto element = "tolerance";
  xml::Place place;
  std::string of;  ///< name of the number
  std::string on;  ///< actuator, drive, joint or body; empty: wherever there is such a number
  std::optional<double> relative;  ///< of the number; exactly one of these two
  std::optional<double> absolute;  ///< in the number's unit
  void visit(auto& v) {
    v.required("of", of);
    v("on", on);
    v("relative", relative, xml::at_least_zero);
    v("absolute", absolute, xml::at_least_zero);
  }
};

/// Another robot.xml whose parts belong to this robot; its own name is not used.
struct Include {
  static constexpr auto element = "include";
  xml::Place place;
  std::string file;    ///< relative to the including file
  int ecu_offset = 0;  ///< added to every ecu
  void visit(auto& v) {
    v.required("file", file);
    v("ecu_offset", ecu_offset, xml::Range{-127, 127});
  }
};

/// Another robot.xml, reflected at the plane y = 0: a left arm from a right one. Names that begin
/// with `from` begin with `to` instead, in references too; the same joint angles are mirror images.
struct Mirror {
  static constexpr auto element = "mirror";
  xml::Place place;
  std::string file;
  std::string from, to;  ///< "left_", "right_"
  int ecu_offset = 0;    ///< added to every ecu
  void visit(auto& v) {
    v.required("file", file);
    v.required("from", from);
    v.required("to", to);
    v("ecu_offset", ecu_offset, xml::Range{-127, 127});
  }
};

/// A robot. As `read_robot` returns it, it is whole: no includes, mirrors and pretensions are
/// left.
struct Robot {
  static constexpr auto element = "robot";
  xml::Place place;
  std::string name;
  std::vector<Skeleton> skeletons;  ///< one a part; `bodies()` and `joints()` see them all
  std::vector<MotorType> motor_types;
  std::vector<SensorType> sensor_types;
  std::vector<Actuator> actuators;
  std::vector<Drive> drives;  ///< without tendons: for diagnosis, not on the bus
  std::vector<JointSensor> joint_sensors;
  std::vector<Potentiometer> potentiometers;
  std::vector<Imu> imus;
  std::vector<BusPlan> can_buses;  ///< as they stand; `buses()` is never empty
  std::vector<Effect> effects;
  std::vector<Tolerance> tolerances;    ///< the last one that names a number counts
  std::vector<Pretension> pretensions;  ///< the last one that names an actuator counts
  std::vector<Include> includes;
  std::vector<Mirror> mirrors;
  void visit(auto& v) {
    v.required("name", name);
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
  /// Of the joint sensors, then of the potentiometers.
  std::vector<AnalogInput> analog_inputs() const;
  /// Addresses in use, ascending.
  std::vector<int> ecus() const;
  /// The CAN buses in the order of the file; where none is named, one with every ECU.
  std::vector<BusPlan> buses() const;
  Vec3 gravity_m_per_s2() const;  ///< zero when no part gives it
  /// Throw std::out_of_range when the robot has no type of that name (read_robot refuses that).
  const MotorType& motor_of(const Actuator& actuator) const;
  const SensorType& sensors_of(const Actuator& actuator) const;
};

/// Reads robot.xml with its includes and mirrors, and checks every reference.
/// Throws xml::Errors with every mistake found: place, value, remedy.
Robot read_robot(const std::string& file);

/// One flat robot.xml; reads back to the same bits.
std::string write_robot(const Robot& robot);

}  // namespace erp
