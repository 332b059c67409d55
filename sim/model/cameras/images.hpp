#pragma once
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "sim/model/cameras/camera.hpp"

/// Infrared images of a robot with reflecting balls: bright spots on a dark background, some
/// occluded by bones.
namespace sim::cameras {

/// Eight bits per pixel, row by row.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

struct Ball {
  Vec3 at_m;
  double radius_m;
};
/// A bone that occludes balls: a capsule, all points within a radius of a line segment.
struct Bone {
  Vec3 from_m, to_m;
  double radius_m;
};

struct Light {
  double background = 12, ball = 210;  ///< mean brightness of background and balls, 0 … 255
  double noise = 4;                    ///< standard deviation
};

/// Renders balls with nine rays per pixel. The noise is generated once and added to each image with
/// a random shift.
class Painter {
 public:
  Painter(const Camera& camera, const Light& light, std::uint64_t seed);

  /// Renders an image. The reference is valid until the next call.
  const Image& paint(std::span<const Ball> balls, std::span<const Bone> bones);

 private:
  void draw(const Ball& ball, std::span<const Bone> bones);
  bool lit(const Ball& ball, std::span<const Bone> bones, const Pixel& pixel) const;

  Camera camera_;
  Light light_;
  std::mt19937_64 random_;
  std::vector<float> noise_;
  std::vector<float> brightness_;
  Image image_;
};

}  // namespace sim::cameras
