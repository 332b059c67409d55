#pragma once
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/errors.hpp"
#include "interfaces/xml/words.hpp"

namespace erp {

/// What the structure of robot.xml cannot say: references, the joint tree, the ECUs, the tendons.
/// Every mistake found, none if the robot is sound. `read_robot` throws them; robots that do not
/// come from a file (imported, fitted) are to be checked with this.
std::vector<xml::Error> check_robot(const Robot& robot);

namespace robot_check {

/// The bounds of interfaces/idl/*.idl; a test compares them with the generated messages.
inline constexpr std::size_t longest_name = 32;
inline constexpr std::size_t most_actuators = 64, most_joints = 128, most_bodies = 128,
                             most_imus = 32, most_path_elements = 12;

/// Collects errors about elements that know their place.
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

inline std::string place_words(const xml::Place& place) {
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
