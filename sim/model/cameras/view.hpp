#pragma once
#include <string>
#include <vector>

#include "sim/model/cameras/camera.hpp"

/// Cameras and markers of an XML file.
namespace sim::cameras {

/// `<marker body="forearm" at_m="0.05 0 -0.1"/>`: a ball's centre, in the body's frame.
struct MarkerConfig {
  static constexpr auto element = "marker";
  static constexpr auto description = "Bright ball on a body.";
  xml::Place place;
  std::string body;
  xml::Vec3 at_m{0, 0, 0};
  void visit(auto& v) {
    v.required("body", body, "Body that carries the marker.");
    v.required("at_m", at_m, "Centre of the ball in the frame of the body.");
  }
};

/// `<camera_view>`, a file: cameras and markers, for the component that detects markers and for
/// programs that predict its images.
struct ViewConfig {
  static constexpr auto element = "camera_view";
  static constexpr auto description = "Cameras and markers.";
  xml::Place place;
  std::vector<CameraConfig> cameras;
  std::vector<MarkerConfig> markers;
  void visit(auto& v) { v.list(cameras), v.list(markers); }
};

}  // namespace sim::cameras
