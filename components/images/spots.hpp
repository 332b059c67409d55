#pragma once
#include <vector>

#include "sim/model/cameras/images.hpp"

namespace images {

/// A bright spot of an image.
struct Spot {
  sim::cameras::Pixel centre;  ///< centre of brightness
  double area_px = 0;
  bool at_edge = false;  ///< the spot touches the image's edge and may be cut off
};

struct SpotOptions {
  int threshold = 90;         ///< grey level, 0 … 255; pixels of a spot are brighter
  double min_area_px = 6;     ///< smaller ones are noise
  double max_area_px = 2000;  ///< larger ones are lamps
};

/// The spots of an image, in no particular order.
std::vector<Spot> find_spots(const sim::cameras::Image& image, const SpotOptions& options);

}  // namespace images
