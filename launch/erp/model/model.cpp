#include "launch/erp/model/model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <ostream>
#include <set>
#include <stdexcept>

#include "interfaces/recording/csv.hpp"
#include "interfaces/robot/check.hpp"
#include "interfaces/robot/mass.hpp"
#include "interfaces/xml/xml.hpp"
#include "launch/erp/text/text_files.hpp"
#include "sim/control/pose_plan.hpp"
#include "sim/formats/formats.hpp"
#include "sim/model/effects/library.hpp"
#include "sim/model/skeleton/joint_reading.hpp"

namespace launch {
namespace {

std::string in_format_of(const std::string& file, const erp::Robot& robot) {
  if (file.ends_with(".mjcf.xml")) return formats::to_mjcf(robot);
  if (file.ends_with(".dae")) return formats::to_collada(robot);
  if (file.ends_with(".urdf")) return formats::to_urdf(robot);
  if (file.ends_with(".sdf")) return formats::to_sdf(robot);
  if (file.ends_with(".svg")) return formats::to_svg(robot);
  throw std::invalid_argument(
      file + ": unknown file name extension; use .dae, .mjcf.xml, .urdf, .sdf or .svg");
}

erp::Robot from_format_of(const std::string& file) {
  if (file.ends_with(".dae")) return formats::from_collada(file);
  if (file.ends_with(".urdf")) return formats::from_urdf(file);
  if (file.ends_with(".sdf")) return formats::from_sdf(file);
  throw std::invalid_argument(file +
                              ": cannot import this file name extension; use .dae, .urdf or .sdf");
}

std::vector<sim::TimedPose> poses_in(const std::string& file, const erp::Robot& robot) {
  const recording::Table table = recording::read_table(file);
  try {
    return sim::poses_of(table, robot);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(file + ": " + error.what());
  }
}

std::string description(const erp::Drive& drive) {
  const auto* slide = std::get_if<erp::Slide>(&drive.load.at(0));
  const char* unit = drive.control == erp::DriveControl::voltage   ? "V"
                     : drive.control == erp::DriveControl::current ? "A"
                     : slide                                       ? "N"
                                                                   : "Nm";
  const std::string load = slide
                               ? fmt::format("a slide of {:.6g} kg", slide->mass_kg)
                               : fmt::format("a shaft of {:.6g} kg m²",
                                             std::get<erp::Shaft>(drive.load.at(0)).inertia_kg_m2);
  return fmt::format("{}: {:.6g} {} per volt of control, {}", drive.name, drive.gain, unit, load);
}

}  // namespace

ModelProperties properties_of(const erp::Robot& robot) {
  ModelProperties properties{.name = robot.name};
  for (const auto& body : robot.bodies())
    ++properties.bodies, properties.mass_kg += mass_of(body).mass_kg;
  for (const auto& joint : robot.joints())
    ++properties.joints, properties.degrees_of_freedom += sim::coordinates_of(joint.type);
  std::set<int> ecus;
  for (const auto& actuator : robot.actuators) {
    ++properties.actuators;
    properties.muscles += !actuator.tendon.path.empty();
    ecus.insert(actuator.ecu);
  }
  properties.drives = static_cast<int>(robot.drives.size());
  properties.ecus = static_cast<int>(ecus.size());
  properties.buses = ecus.empty() ? 0 : static_cast<int>(robot.buses().size());
  return properties;
}

int model_info(const std::string& robot_file, bool json, std::ostream& out) {
  const erp::Robot robot = erp::read_robot(robot_file);
  const ModelProperties properties = properties_of(robot);
  out << fmt::format(
      fmt::runtime(json ? "{{\"robot\": \"{}\", \"bodies\": {}, \"joints\": {}, "
                          "\"degrees_of_freedom\": {}, \"actuators\": {}, \"muscles\": {}, "
                          "\"mass_kg\": {:.6g}, \"ecus\": {}, \"buses\": {}, \"drives\": {}}}\n"
                        : "robot               {}\nbodies              {}\njoints              {}\n"
                          "degrees of freedom  {}\nactuators           {}\nmuscles             {}\n"
                          "mass                {:.6g} kg\nECUs                {}\n"
                          "buses               {}\ndrives              {}\n"),
      properties.name, properties.bodies, properties.joints, properties.degrees_of_freedom,
      properties.actuators, properties.muscles, properties.mass_kg, properties.ecus,
      properties.buses, properties.drives);
  for (const erp::Drive& drive : robot.drives)
    if (!json) out << fmt::format("drive               {}\n", description(drive));
  if (!json)
    for (const erp::Effect& effect : robot.effects)
      out << fmt::format("effect              {} on {}\n", effect.type, effect.on);
  return 0;
}

int model_export(const std::string& robot_file, const std::string& out_file) {
  const erp::Robot robot = erp::read_robot(robot_file);
  write_file(out_file, in_format_of(out_file, robot));
  const bool is_skeleton_format = out_file.ends_with(".urdf") || out_file.ends_with(".sdf");
  if (is_skeleton_format && !robot.actuators.empty())
    fmt::print(stderr,
               "{} contains only the skeleton; the format cannot represent {} actuators with "
               "tendons and sensors\n",
               out_file, robot.actuators.size());
  if (!out_file.ends_with(".dae") && !out_file.ends_with(".svg") && !robot.effects.empty())
    fmt::print(stderr, "{} contains the nominal robot; the format cannot represent {} effects\n",
               out_file, robot.effects.size());
  return 0;
}

int model_import(const std::string& foreign_file, const std::string& robot_file) {
  const erp::Robot robot = from_format_of(foreign_file);
  xml::throw_if_any(erp::check_robot(robot));
  write_file(robot_file, erp::write_robot(robot));
  return 0;
}

int model_effects(const std::string& part, std::ostream& out) {
  bool is_listed = false;
  for (sim::effects::AnyEffect effect : sim::effects::library()) {
    const sim::effects::About& about = sim::effects::about(effect);
    if (about.type.find(part) == about.type.npos) continue;
    is_listed = true;
    const bool on_robot = about.seat == sim::effects::Seat::robot;
    out << fmt::format("{}  on: {}  excitation: {}\n", about.type,
                       on_robot ? "robot, by its name" : word(about.seat), about.shown_by);
    for (const auto& p : sim::effects::parameters(effect))
      out << fmt::format("    {:<26} {:>8} … {:<8} default {}{}\n", p.name, p.bounds.low,
                         p.bounds.high, *p.value, p.fitted ? "" : ", not fitted by erp gap");
  }
  if (!is_listed)
    throw std::invalid_argument("no effect type contains \"" + part +
                                "\"; erp model effects lists all");
  return 0;
}

int model_balance(const std::string& robot_file, double least_N, double rest_N, std::ostream& out) {
  const erp::Robot robot = erp::read_robot(robot_file);
  const sim::Holding holding =
      sim::hold_pose(robot, sim::starting_pose(robot), {.rest_N = rest_N, .least_N = least_N});
  erp::Robot part;
  part.name = robot.name;
  for (std::size_t k = 0; k < robot.actuators.size(); ++k)
    part.pretensions.push_back(
        {{}, robot.actuators[k].name, std::round(100 * holding.tension_N[k]) / 100});
  out << xml::write(part);
  fmt::print(stderr, "unbalanced torque: {:.3g} Nm\n", holding.unbalanced_Nm);
  return 0;
}

int model_lengths(const std::string& robot_file, const std::string& table_file, double least_N,
                  double rest_N, std::ostream& out) {
  const erp::Robot robot = erp::read_robot(robot_file);
  const auto poses = poses_in(table_file, robot);
  const sim::LengthPlan plan =
      sim::lengths_through(robot, poses, {.holding = {.rest_N = rest_N, .least_N = least_N}});
  recording::write_csv(plan.table, out);
  fmt::print(stderr, "unbalanced torque: at most {:.3g} Nm, at {:.6g} s\n", plan.unbalanced_Nm,
             plan.at_s);
  return 0;
}

}  // namespace launch
