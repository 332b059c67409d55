#pragma once
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/errors.hpp"
#include "interfaces/xml/words.hpp"

namespace erp {

/// Checks that an XSD cannot express: references, the joint tree, the ECUs, the tendons. Returns
/// all errors. `read_robot` throws them. Call this for robots that do not come from a file
/// (imported, fitted).
std::vector<xml::Error> check_robot(const Robot& robot);

namespace robot_check {

/// The bounds of interfaces/idl/*.idl; a test compares them with the generated messages.
inline constexpr std::size_t max_name_length = 32;
inline constexpr std::size_t max_actuators = 64, max_joints = 128, max_bodies = 128, max_imus = 32,
                             max_path_elements = 12;

/// Collects errors about elements of robot.xml.
class Findings {
 public:
  template <class Item>
  void add(const Item& item, const std::string& what, const std::string& remedy) {
    errors.push_back(xml::error_in(Item::element, item.place, what, remedy));
  }
  std::vector<xml::Error> errors;
};

template <class Items>
std::vector<std::string> names_of(const Items& items) {
  std::vector<std::string> names;
  names.reserve(items.size());
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

inline std::string place_text(const xml::Place& place) {
  return place.file + ":" + std::to_string(place.line);
}

void check_names(const Robot& robot, Findings& findings);
void check_references(const Robot& robot, Findings& findings);
void check_ecus(const Robot& robot, Findings& findings);
void check_buses(const Robot& robot, Findings& findings);
void check_skeleton(const Robot& robot, Findings& findings);
void check_tendons(const Robot& robot, Findings& findings);
void check_drives(const Robot& robot, Findings& findings);

}  // namespace robot_check
}  // namespace erp
