#include "launch/erp/model.hpp"

#include <fmt/format.h>

#include <fstream>
#include <ostream>
#include <set>
#include <stdexcept>

#include "sim/formats/formats.hpp"

namespace launch {
namespace {

std::string in_format_of(const std::string& file, const erp::Robot& robot) {
  if (file.ends_with(".mjcf.xml")) return formats::to_mjcf(robot);
  throw std::invalid_argument(file + ": no format has this ending; write .mjcf.xml");
}

int freedom_of(erp::JointType type) {
  return type == erp::JointType::spherical ? 3 : type == erp::JointType::revolute ? 1 : 0;
}

}  // namespace

ModelFigures figures_of(const erp::Robot& robot) {
  ModelFigures f{.name = robot.name};
  for (const auto& body : robot.bodies()) ++f.bodies, f.mass_kg += body.mass_kg;
  for (const auto& joint : robot.joints())
    ++f.joints, f.degrees_of_freedom += freedom_of(joint.type);
  std::set<int> ecus;
  for (const auto& actuator : robot.actuators) {
    ++f.actuators;
    f.muscles += !actuator.tendon.path.empty();
    ecus.insert(actuator.ecu);
  }
  f.ecus = static_cast<int>(ecus.size());
  f.buses = ecus.empty() ? 0 : 1;  // all ECUs of a robot share one
  return f;
}

int model_info(const std::string& robot_file, bool json, std::ostream& out) {
  const ModelFigures f = figures_of(erp::read_robot(robot_file));
  out << fmt::format(
      fmt::runtime(json ? "{{\"robot\": \"{}\", \"bodies\": {}, \"joints\": {}, "
                          "\"degrees_of_freedom\": {}, \"actuators\": {}, \"muscles\": {}, "
                          "\"mass_kg\": {:.6g}, \"ecus\": {}, \"buses\": {}}}\n"
                        : "robot               {}\nbodies              {}\njoints              {}\n"
                          "degrees of freedom  {}\nactuators           {}\nmuscles             {}\n"
                          "mass                {:.6g} kg\nECUs                {}\n"
                          "buses               {}\n"),
      f.name, f.bodies, f.joints, f.degrees_of_freedom, f.actuators, f.muscles, f.mass_kg, f.ecus,
      f.buses);
  return 0;
}

int model_export(const std::string& robot_file, const std::string& out_file) {
  const std::string text = in_format_of(out_file, erp::read_robot(robot_file));
  std::ofstream out(out_file);
  if (!(out << text) || !out.flush())
    throw std::invalid_argument(out_file + ": cannot be written; name another file");
  return 0;
}

}  // namespace launch
