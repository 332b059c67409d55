#pragma once
#include <iosfwd>
#include <string>

#include "interfaces/robot/robot.hpp"

/// `erp model`: robots in other formats, and in figures.
namespace launch {

/// What a robot has.
struct ModelFigures {
  std::string name;
  int bodies = 0, joints = 0, degrees_of_freedom = 0;
  int actuators = 0, muscles = 0;  ///< muscles: actuators that pull a tendon
  double mass_kg = 0;
  int ecus = 0, buses = 0;
  int drives = 0;  ///< on no bus
};
ModelFigures figures_of(const erp::Robot& robot);

/// A line a figure, or one JSON object. Throws xml::Errors. Returns the exit code.
int model_info(const std::string& robot_file, bool json, std::ostream& out);

/// Prints the effects whose type contains `part`: on what they sit, what shows them, their
/// parameters with bounds. Throws std::invalid_argument when there is none. Returns the exit code.
int model_effects(const std::string& part, std::ostream& out);

/// Prints, as a part to be included in robot.xml, the pretensions that balance the starting pose
/// against gravity: no tendon below `least_N`, all as near to `rest_N` as can be; and on stderr
/// what they cannot balance. Throws xml::Errors. Returns the exit code.
int model_balance(const std::string& robot_file, double least_N, double rest_N, std::ostream& out);

/// Prints the line lengths that take the robot through the joint angles of a table or recording, as
/// a trajectory for `target`. Throws xml::Errors, RecordingError, std::invalid_argument. Returns
/// the exit code.
int model_lengths(const std::string& robot_file, const std::string& table_file, double least_N,
                  double rest_N, std::ostream& out);

/// Writes the robot of a .dae file, or the skeleton of a .urdf or .sdf file, as robot.xml. Throws
/// as formats::from_urdf does, and xml::Errors for what no robot may be. Returns the exit code.
int model_import(const std::string& foreign_file, const std::string& robot_file);

/// The format follows from the ending: .dae, .mjcf.xml, .urdf, .sdf; .svg is a picture. Throws
/// xml::Errors, std::invalid_argument for another ending or what the format cannot say. Returns the
/// exit code.
int model_export(const std::string& robot_file, const std::string& out_file);

}  // namespace launch
