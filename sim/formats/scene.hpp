#pragma once
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/model/skeleton/pose.hpp"

/// A robot in its starting pose as strokes in the world, for pictures.
namespace formats {

/// A stroke of some width through points: a sphere has one point, a capsule two, a tendon many.
struct Stroke {
  std::vector<sim::Vec3> points;
  double width_m = 0;
  const char* fill;
  const char* edge = nullptr;  ///< nullptr: a thin line of the fill's colour
  std::string title;
  int layer = 0;  ///< bones lie under pulleys under muscles
};

/// Bones, joints, pulleys and muscles. Throws std::invalid_argument as RobotTree and Routing do.
std::vector<Stroke> strokes_of(const erp::Robot& robot);

}  // namespace formats
