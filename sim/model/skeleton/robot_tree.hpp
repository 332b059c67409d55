#pragma once
#include <span>
#include <string>
#include <vector>

#include "interfaces/robot/mass.hpp"
#include "interfaces/robot/robot.hpp"

/// A robot's bodies and joints in tree order: parents before children.
namespace sim {

struct TreeBody {
  erp::Body body;
  int parent = -1;  ///< index of the parent body; −1: a root, fixed to the world
  int joint = -1;   ///< index into the robot's joints; −1: a root
  erp::Mass mass;
};

/// Index of `body` in `names`. Throws std::invalid_argument if it is not there; `what`, for example
/// "an attached load", names the element that refers to the body.
std::size_t body_named(std::span<const std::string> names, const std::string& body,
                       const std::string& what);

struct RobotTree {
  std::vector<TreeBody> bodies;    ///< parents first
  std::vector<erp::Joint> joints;  ///< as in robot.xml
  std::vector<std::string> names;  ///< names of the bodies

  /// Throws std::invalid_argument, with the name of the element, for a body moved by two joints, a
  /// loop, an unknown body, a moved body without mass or inertia, a root with mass, or a free body
  /// whose parent moves.
  explicit RobotTree(const erp::Robot& robot);
};

}  // namespace sim
