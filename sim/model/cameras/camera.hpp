#pragma once
#include <optional>
#include <string>

#include "interfaces/xml/fields.hpp"
#include "sim/model/skeleton/pose.hpp"

/// A pinhole camera with radial distortion.
///
///   x = X/Z, y = Y/Z in the camera frame: X right, Y down, Z forwards
///   (u, v) = f (1 + k₁ ρ² + k₂ ρ⁴) (x, y) + (c_u, c_v),    ρ² = x² + y²
///
/// Source: Brown 1966. The parameters have the names of OpenCV's calib3d, so its calibration results can
/// be used directly.
namespace sim::cameras {

using Pixel = Eigen::Vector2d;

/// `<camera name="left" at_m="…" looks_at_m="…"/>`
struct CameraConfig {
  static constexpr auto element = "camera";
  static constexpr auto description =
      "Pinhole camera with radial distortion, with the parameters of OpenCV.";
  xml::Place place;
  std::string name;
  xml::Vec3 at_m{0, 0, 0}, looks_at_m{0, 0, 0};
  xml::Vec3 up{0, 0, 1};
  double focal_px = 800;
  int width_px = 640, height_px = 480;
  double centre_u_px = 0, centre_v_px = 0;
  double k1 = 0, k2 = 0;
  void visit(auto& v) {
    v.required("name", name, "Name of the camera; images and image points carry it.");
    v.required("at_m", at_m, "Position of the centre of projection in the world.");
    v.required("looks_at_m", looks_at_m, "Point in the world on the optical axis.");
    v("up", up, "Approximate direction in the world of the image's upper edge.");
    v("focal_px", focal_px, {xml::positive, "Focal length f."});
    v("width_px", width_px, {xml::Range{16, 8192}, "Width of the image."});
    v("height_px", height_px, {xml::Range{16, 8192}, "Height of the image."});
    v("centre_u_px", centre_u_px,
      "Column of the optical axis, from the middle of the image, to the right.");
    v("centre_v_px", centre_v_px,
      "Row of the optical axis, from the middle of the image, downwards.");
    v("k1", k1, "Coefficient k₁ of radial distortion, of ρ²; 0: none.");
    v("k2", k2, "Coefficient k₂ of radial distortion, of ρ⁴; 0: none.");
  }
};

class Camera {
 public:
  /// Throws std::invalid_argument if the viewing direction is zero or parallel to `up`.
  explicit Camera(const CameraConfig& config);

  /// The pixel, which may lie outside the image; empty if the point is behind the camera.
  std::optional<Pixel> project(const Vec3& world_m) const;
  /// Unit direction of a pixel's ray in the world; the ray is at_m() + t ray(pixel).
  Vec3 ray(const Pixel& pixel) const;
  const Vec3& at_m() const { return at_m_; }
  const CameraConfig& config() const { return config_; }
  bool sees(const Pixel& pixel) const {
    return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= config_.width_px - 1 &&
           pixel.y() <= config_.height_px - 1;
  }

 private:
  CameraConfig config_;
  Vec3 at_m_;
  Eigen::Matrix3d axes_;  ///< axes of the camera in the world, as columns
  Pixel centre_;
};

}  // namespace sim::cameras
