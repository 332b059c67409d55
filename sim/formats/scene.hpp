#pragma once
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/model/skeleton/pose.hpp"

/// A robot in its starting pose as strokes in the world, for pictures.
namespace formats {

/// A line of a given width through points: a sphere has one point, a capsule two, a tendon many.
struct Stroke {
  std::vector<sim::Vec3> points;
  double width_m = 0;
  const char* fill;
  const char* edge = nullptr;  ///< nullptr: no separate edge
  std::string title;
  int layer = 0;  ///< order: bones, pulleys, muscles on top
};

/// Bones, joints, pulleys and muscles. Throws std::invalid_argument like RobotTree and Routing.
std::vector<Stroke> strokes_of(const erp::Robot& robot);

}  // namespace formats
