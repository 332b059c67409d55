#include "components/motion_capture/stereo.hpp"

#include <cmath>

namespace capture {
namespace {

constexpr double parallel_sine_square = 1e-9;  // chosen: below, rays count as parallel

using sim::Vec3;

std::vector<Vec3> rays(const sim::cameras::Camera& camera, std::span<const Spot> spots) {
  std::vector<Vec3> directions;
  for (const Spot& spot : spots) directions.push_back(camera.ray(spot.centre));
  return directions;
}

}  // namespace

std::vector<StereoPoint> triangulate(const sim::cameras::Camera& left_camera,
                                     std::span<const Spot> left,
                                     const sim::cameras::Camera& right_camera,
                                     std::span<const Spot> right, const StereoOptions& options) {
  const auto d = rays(left_camera, left), e = rays(right_camera, right);
  const Vec3 baseline_m = left_camera.at_m() - right_camera.at_m();
  const auto in_range = [&](double distance_m) {
    return distance_m > options.min_distance_m && distance_m < options.max_distance_m;
  };
  std::vector<StereoPoint> points;
  for (std::size_t k = 0; k < d.size(); ++k)
    for (std::size_t m = 0; m < e.size(); ++m) {
      const double cosine = d[k].dot(e[m]), sine_square = 1 - cosine * cosine;
      if (sine_square < parallel_sine_square) continue;
      const double on_d = d[k].dot(baseline_m), on_e = e[m].dot(baseline_m);
      const double s = (cosine * on_e - on_d) / sine_square,
                   t = (on_e - cosine * on_d) / sine_square;
      const Vec3 p = left_camera.at_m() + s * d[k], q = right_camera.at_m() + t * e[m];
      const double gap_m = (p - q).norm();
      if (gap_m <= options.gap_m && in_range(s) && in_range(t))
        points.push_back({(p + q) / 2, gap_m, k, m});
    }
  return points;
}

}  // namespace capture
