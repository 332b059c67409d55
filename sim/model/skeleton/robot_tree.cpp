#include "sim/model/skeleton/robot_tree.hpp"

#include <algorithm>
#include <stdexcept>

namespace sim {

namespace {

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

int joint_that_moves(const std::vector<erp::Joint>& joints, const std::string& body) {
  int found = -1;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].child != body) continue;
    if (found >= 0) refuse("body \"" + body + "\" is moved by two joints");
    found = static_cast<int>(j);
  }
  return found;
}

void check(const erp::Body& body, const erp::Mass& mass, bool moved) {
  const auto& i = mass.inertia_kg_m2;
  if (moved && !(mass.mass_kg > 0 && i[0] > 0 && i[1] > 0 && i[2] > 0))
    refuse("body \"" + body.name + "\" is moved by a joint and needs mass and inertia");
  if (!moved && mass.mass_kg > 0)
    refuse("body \"" + body.name + "\" has mass but no joint moves it");
}

}  // namespace

std::size_t body_named(std::span<const std::string> names, const std::string& body,
                       const std::string& what) {
  const auto found = std::ranges::find(names, body);
  if (found == names.end())
    refuse(what + " refers to body \"" + body + "\", which the robot does not have");
  return static_cast<std::size_t>(found - names.begin());
}

RobotTree::RobotTree(const erp::Robot& robot) : joints(robot.joints()) {
  std::vector<erp::Body> left = robot.bodies();
  const auto index = [this](const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? -1 : static_cast<int>(found - names.begin());
  };
  while (!left.empty()) {
    // The next body whose parent is already in the tree.
    const auto next = std::find_if(left.begin(), left.end(), [&](const erp::Body& body) {
      const int joint = joint_that_moves(joints, body.name);
      return joint < 0 || index(joints[joint].parent) >= 0;
    });
    if (next == left.end())
      refuse("body \"" + left.front().name + "\" is connected to an unknown body or to itself");
    const int joint = joint_that_moves(joints, next->name);
    const erp::Mass mass = mass_of(*next);
    check(*next, mass, joint >= 0);
    const int parent = joint < 0 ? -1 : index(joints[joint].parent);
    if (joint >= 0 && joints[joint].type == erp::JointType::free && bodies[parent].joint >= 0)
      refuse("free body \"" + next->name + "\": the parent of a free joint must be a root");
    bodies.push_back({*next, parent, joint, mass});
    names.push_back(next->name);
    left.erase(next);
  }
}

}  // namespace sim
