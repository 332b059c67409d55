#pragma once
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "sim/model/cameras/camera.hpp"

/// What infrared cameras see of a robot with reflecting balls on it: bright spots before a dark
/// ground, some hidden behind its bones.
namespace sim::cameras {

/// Eight bits a pixel, row by row.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

struct Ball {
  Vec3 at_m;
  double radius_m;
};
/// A bone that hides what is behind it: all points within a radius of a line.
struct Bone {
  Vec3 from_m, to_m;
  double radius_m;
};

struct Light {
  double ground = 12, ball = 210;  ///< mean brightness, of 255
  double noise = 4;                ///< standard deviation
};

/// Draws balls ray by ray, nine a pixel; noise is drawn once and laid shifted under each image.
class Painter {
 public:
  Painter(const Camera& camera, const Light& light, std::uint64_t seed);

  /// The image of this instant. The returned one is the painter's own.
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
