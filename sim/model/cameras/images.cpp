#include "sim/model/cameras/images.hpp"

#include <algorithm>
#include <cmath>

namespace sim::cameras {
namespace {

constexpr int rays_per_side = 3, rays_per_pixel = rays_per_side * rays_per_side;  // chosen
constexpr double reach_factor = 1.5;  // chosen: radius of the drawn square over radius of the ball
constexpr double margin_px = 2;       // chosen

/// Shortest distance between two segments (Ericson 2005, 5.1.9).
double segment_distance_m(const Vec3& p, const Vec3& to_p, const Vec3& q, const Vec3& to_q) {
  const Vec3 d = to_p - p, e = to_q - q, r = p - q;
  const double a = d.squaredNorm(), b = e.squaredNorm(), f = e.dot(r), c = d.dot(r), g = d.dot(e);
  const double determinant = a * b - g * g;
  double s = determinant > 1e-12 ? std::clamp((g * f - c * b) / determinant, 0.0, 1.0) : 0;
  double t = b > 0 ? (g * s + f) / b : 0;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((g * t - c) / a, 0.0, 1.0);
  }
  return (r + s * d - t * e).norm();
}

}  // namespace

Painter::Painter(const Camera& camera, const Light& light, std::uint64_t seed)
    : camera_(camera), light_(light), random_(seed) {
  image_.width = camera.config().width_px, image_.height = camera.config().height_px;
  const auto size =
      static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(image_.height);
  image_.pixels.resize(size), brightness_.resize(size), noise_.resize(2 * size);
  std::normal_distribution<float> normal(0, static_cast<float>(light.noise));
  for (float& brightness : noise_) brightness = normal(random_);
}

const Image& Painter::paint(std::span<const Ball> balls, std::span<const Bone> bones) {
  std::ranges::fill(brightness_, static_cast<float>(light_.background));
  for (const Ball& ball : balls) draw(ball, bones);
  const std::size_t from =
      std::uniform_int_distribution<std::size_t>(0, brightness_.size())(random_);
  for (std::size_t k = 0; k < brightness_.size(); ++k)
    image_.pixels[k] = static_cast<std::uint8_t>(
        std::clamp(brightness_[k] + noise_[from + k] + 0.5F, 0.0F, 255.0F));
  return image_;
}

void Painter::draw(const Ball& ball, std::span<const Bone> bones) {
  const auto centre = camera_.project(ball.at_m);
  if (!centre) return;
  const double distance_m = (ball.at_m - camera_.at_m()).norm();
  const double reach_px =
      reach_factor * camera_.config().focal_px * ball.radius_m / distance_m + margin_px;
  const auto pixel_index = [](double x, int size) {
    return std::clamp(static_cast<int>(x), 0, size);
  };
  for (int v = pixel_index(centre->y() - reach_px, image_.height);
       v < pixel_index(centre->y() + reach_px + 1, image_.height); ++v)
    for (int u = pixel_index(centre->x() - reach_px, image_.width);
         u < pixel_index(centre->x() + reach_px + 1, image_.width); ++u) {
      int lit_rays = 0;
      for (int k = 0; k < rays_per_pixel; ++k)
        lit_rays +=
            lit(ball, bones,
                Pixel(u + (k % rays_per_side - 1) / 3.0, v + (k / rays_per_side - 1) / 3.0));
      float& pixel = brightness_[static_cast<std::size_t>(v * image_.width + u)];
      const double bright = light_.background + lit_rays / static_cast<double>(rays_per_pixel) *
                                                    (light_.ball - light_.background);
      pixel = std::max(pixel, static_cast<float>(bright));
    }
}

bool Painter::lit(const Ball& ball, std::span<const Bone> bones, const Pixel& pixel) const {
  const Vec3 ray = camera_.ray(pixel), to_ball = ball.at_m - camera_.at_m();
  const double along_m = to_ball.dot(ray);
  if ((to_ball - along_m * ray).norm() > ball.radius_m) return false;
  const Vec3 end = camera_.at_m() + along_m * ray;
  return std::ranges::none_of(bones, [&](const Bone& bone) {
    return segment_distance_m(camera_.at_m(), end, bone.from_m, bone.to_m) < bone.radius_m;
  });
}

}  // namespace sim::cameras
