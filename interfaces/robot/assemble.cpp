#include "interfaces/robot/assemble.hpp"

#include <algorithm>
#include <filesystem>

#include "interfaces/xml/xml.hpp"

namespace erp {
namespace {

using xml::error_in;

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// Appends types that are not in `to` yet. Several parts may define the same type.
template <class Type>
void append_new(std::vector<Type>& to, const std::vector<Type>& from) {
  for (const Type& type : from) {
    const std::string text = xml::write(type);
    const auto is_equal = [&](const Type& other) { return xml::write(other) == text; };
    if (std::none_of(to.begin(), to.end(), is_equal)) to.push_back(type);
  }
}

void append_part(Robot& robot, const Robot& part) {
  append(robot.skeletons, part.skeletons);
  append(robot.pretensions, part.pretensions);
  append(robot.actuators, part.actuators);
  append(robot.drives, part.drives);
  append(robot.joint_sensors, part.joint_sensors);
  append(robot.potentiometers, part.potentiometers);
  append(robot.imus, part.imus);
  append(robot.can_buses, part.can_buses);
  append(robot.effects, part.effects);
  append(robot.tolerances, part.tolerances);
}

void shift_ecus(Robot& part, int offset) {
  for (Actuator& actuator : part.actuators) actuator.ecu += offset;
  for (JointSensor& sensor : part.joint_sensors) sensor.ecu += offset;
  for (Potentiometer& sensor : part.potentiometers) sensor.ecu += offset;
  for (BusPlan& bus : part.can_buses)
    for (int& ecu : bus.ecus) ecu += offset;
}

std::vector<std::string> names_in(const Robot& part) {
  std::vector<std::string> names;
  for (const Body& body : part.bodies()) names.push_back(body.name);
  for (const Joint& joint : part.joints()) names.push_back(joint.name);
  for (const Actuator& actuator : part.actuators) names.push_back(actuator.name);
  for (const Drive& drive : part.drives) names.push_back(drive.name);
  return names;
}

/// Reads files depth first. `open_files_`: the files from the root to the one being read. A file
/// that occurs there twice includes itself.
class Assembler {
 public:
  Robot read(const std::string& file) {
    Robot robot = read_with_parts(file);
    for (const Pretension& pretension : std::exchange(robot.pretensions, {}))
      apply_pretension(robot, pretension);
    xml::throw_if_any(std::move(errors_));
    return robot;
  }

 private:
  /// The robot of a file together with its included and mirrored parts.
  Robot read_with_parts(const std::string& file) {
    open_files_.push_back(std::filesystem::weakly_canonical(file).string());
    ++files_;
    Robot robot;
    const xml::Element root = xml::read_document(file);
    xml::throw_if_any(xml::wrong_root(root, Robot::element));
    xml::Reader::fill(robot, root, errors_);
    const auto own_pretensions = std::exchange(robot.pretensions, {});
    for (const Include& include : std::exchange(robot.includes, {})) add(robot, include, file);
    for (const Mirror& mirror : std::exchange(robot.mirrors, {})) add(robot, mirror, file);
    append(robot.pretensions,
           own_pretensions);  // last, because a later pretension replaces an earlier one
    open_files_.pop_back();
    return robot;
  }

  void add(Robot& robot, const Include& include, const std::string& from_file) {
    Robot part = read_part(include, from_file);
    shift_ecus(part, include.ecu_offset);
    append_part(robot, part);
    append_new(robot.motor_types, part.motor_types);
    append_new(robot.sensor_types, part.sensor_types);
  }

  void add(Robot& robot, const Mirror& mirror, const std::string& from_file) {
    Robot part = read_part(mirror, from_file);
    const auto names = names_in(part);
    const auto has_prefix = [&](const std::string& name) { return name.starts_with(mirror.from); };
    if (!names.empty() && std::none_of(names.begin(), names.end(), has_prefix))
      errors_.push_back(
          error_in(Mirror::element, mirror.place,
                   "no name in " + mirror.file + " begins with from=\"" + mirror.from + "\"",
                   "names there: " + xml::joined(names)));
    part = mirrored(std::move(part), mirror);
    shift_ecus(part, mirror.ecu_offset);
    append_part(robot, part);
    append_new(robot.motor_types, part.motor_types);
    append_new(robot.sensor_types, part.sensor_types);
  }

  void apply_pretension(Robot& robot, const Pretension& pretension) {
    std::vector<std::string> names;
    for (Actuator& actuator : robot.actuators) {
      if (actuator.name == pretension.actuator) {
        actuator.tendon.pretension_N = pretension.tension_N;
        return;
      }
      names.push_back(actuator.name);
    }
    errors_.push_back(
        error_in(Pretension::element, pretension.place,
                 "actuator=\"" + pretension.actuator + "\" refers to an unknown actuator",
                 xml::did_you_mean(pretension.actuator, names)));
  }

  /// Reads the part. If that fails, adds an error and returns an empty robot.
  template <class Reference>
  Robot read_part(const Reference& reference, const std::string& from_file) {
    const std::string file = xml::resolved(reference.file, from_file);
    if (reference.file.empty()) return {};  // already reported as missing
    const auto add_error = [&](const std::string& what, const std::string& remedy) {
      errors_.push_back(error_in(Reference::element, reference.place,
                                 "file=\"" + reference.file + "\" " + what, remedy));
    };
    const auto canonical = std::filesystem::weakly_canonical(file).string();
    if (std::find(open_files_.begin(), open_files_.end(), canonical) != open_files_.end()) {
      add_error("includes itself: " + xml::joined(open_files_, " > ") + " > " + canonical,
                "remove one of these includes");
      return {};
    }
    if (files_ >= max_files) {
      if (files_++ == max_files)
        add_error("is one file too many: the robot already has " + std::to_string(max_files),
                  "check for files that include others twice at each level");
      return {};
    }
    const auto depth = open_files_.size();
    try {
      return read_with_parts(file);
    } catch (const xml::Errors& errors) {
      open_files_.resize(depth);
      for (const xml::Error& error : errors.all())
        error.place.line == 0 ? add_error(error.what, error.remedy) : errors_.push_back(error);
      return {};
    }
  }

  static constexpr int max_files = 500;  // chosen
  int files_ = 0;
  std::vector<std::string> open_files_;
  std::vector<xml::Error> errors_;
};

}  // namespace

Robot assemble_robot(const std::string& file) { return Assembler().read(file); }

}  // namespace erp
