#include "sim/model/skeleton/robot_tree.hpp"

#include <algorithm>
#include <stdexcept>

namespace sim {

namespace {

[[noreturn]] void reject(const std::string& what) { throw std::invalid_argument(what); }

int joint_that_moves(const std::vector<erp::Joint>& joints, const std::string& body) {
  int match = -1;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].child != body) continue;
    if (match >= 0) reject("body \"" + body + "\" is moved by two joints");
    match = static_cast<int>(j);
  }
  return match;
}

void check_mass(const erp::Body& body, const erp::Mass& mass, bool moved) {
  const auto& i = mass.inertia_kg_m2;
  if (moved && !(mass.mass_kg > 0 && i[0] > 0 && i[1] > 0 && i[2] > 0))
    reject("body \"" + body.name + "\" is moved by a joint and needs mass and inertia");
  if (!moved && mass.mass_kg > 0)
    reject("body \"" + body.name + "\" has mass but no joint moves it");
}

}  // namespace

std::size_t body_named(std::span<const std::string> names, const std::string& body,
                       const std::string& what) {
  const auto match = std::ranges::find(names, body);
  if (match == names.end())
    reject(what + " refers to body \"" + body + "\", which the robot does not have");
  return static_cast<std::size_t>(match - names.begin());
}

RobotTree::RobotTree(const erp::Robot& robot) : joints(robot.joints()) {
  std::vector<erp::Body> remaining = robot.bodies();
  const auto index = [this](const std::string& name) {
    const auto match = std::find(names.begin(), names.end(), name);
    return match == names.end() ? -1 : static_cast<int>(match - names.begin());
  };
  while (!remaining.empty()) {
    // The next body whose parent is already in the tree.
    const auto next_body =
        std::find_if(remaining.begin(), remaining.end(), [&](const erp::Body& body) {
          const int joint = joint_that_moves(joints, body.name);
          return joint < 0 || index(joints[joint].parent) >= 0;
        });
    if (next_body == remaining.end())
      reject("body \"" + remaining.front().name +
             "\" is connected to an unknown body or to itself");
    const int joint = joint_that_moves(joints, next_body->name);
    const erp::Mass mass = mass_of(*next_body);
    check_mass(*next_body, mass, joint >= 0);
    const int parent = joint < 0 ? -1 : index(joints[joint].parent);
    if (joint >= 0 && joints[joint].type == erp::JointType::free && bodies[parent].joint >= 0)
      reject("free body \"" + next_body->name + "\": the parent of a free joint must be a root");
    bodies.push_back({*next_body, parent, joint, mass});
    names.push_back(next_body->name);
    remaining.erase(next_body);
  }
}

}  // namespace sim
