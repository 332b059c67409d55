#pragma once
#include <iosfwd>
#include <string>

#include "interfaces/robot/robot.hpp"

/// `erp model`: properties of robots, and conversion to other formats.
namespace launch {

/// Properties of a robot.
struct ModelProperties {
  std::string name;
  int bodies = 0, joints = 0, degrees_of_freedom = 0;
  int actuators = 0, muscles = 0;  ///< muscles: actuators with a tendon
  double mass_kg = 0;
  int ecus = 0, buses = 0;
  int drives = 0;  ///< drives are on no bus
};
ModelProperties properties_of(const erp::Robot& robot);

/// Prints one line per property, or one JSON object. Throws xml::Errors. Returns the exit code.
int model_info(const std::string& robot_file, bool json, std::ostream& out);

/// Prints the effects with `part` in their type: the part of the robot that they act on, the
/// excitation that reveals them, and their parameters with bounds. Throws std::invalid_argument if
/// there is no such effect. Returns the exit code.
int model_effects(const std::string& part, std::ostream& out);

/// Prints the pretensions that hold the starting pose against gravity, as a part to include in
/// robot.xml. No tension is below `least_N`, and all are as close to `rest_N` as possible. Prints
/// the remaining unbalanced torque on stderr. Throws xml::Errors. Returns the exit code.
int model_balance(const std::string& robot_file, double least_N, double rest_N, std::ostream& out);

/// Prints the line lengths for the joint angles of a table or recording, as a trajectory for
/// `target`. Throws xml::Errors, RecordingError, std::invalid_argument. Returns the exit code.
int model_lengths(const std::string& robot_file, const std::string& table_file, double least_N,
                  double rest_N, std::ostream& out);

/// Writes the robot of a .dae file, or the skeleton of a .urdf or .sdf file, as robot.xml. Throws
/// the exceptions of formats::from_urdf, and xml::Errors for an invalid robot. Returns the exit
/// code.
int model_import(const std::string& foreign_file, const std::string& robot_file);

/// Writes the robot in the format of the file name extension: .dae, .mjcf.xml, .urdf, .sdf, or .svg
/// for a picture. Throws xml::Errors, and std::invalid_argument for another extension or a property
/// that the format cannot represent. Returns the exit code.
int model_export(const std::string& robot_file, const std::string& out_file);

/// `erp model loops`: H-infinity control loops of the hinges of a robot, designed from its model.
struct ModelLoopsOptions {
  std::string robot, loops;  ///< robot.xml; loop shape file, or empty for the default
  std::string poses;         ///< CSV of postures to check; empty: the starting posture only
  std::string out;           ///< picture file; empty: none
};

/// Prints the stability margin of the design and of each posture; draws the singular values of the
/// loops. Throws xml::Errors, RecordingError, std::invalid_argument. Returns 0 if the loops are
/// stable in all postures, otherwise 1.
int model_loops(const ModelLoopsOptions& options, std::ostream& out);

}  // namespace launch
