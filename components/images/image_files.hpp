#pragma once
#include <optional>
#include <string>

#include "sim/model/cameras/images.hpp"

/// Image files with eight bits per pixel.
namespace images {

/// <folder>/<camera>_00017.png
std::string image_name(const std::string& folder, const std::string& camera, std::uint64_t number);
/// Reads any format that OpenCV supports, as greyscale. nullopt if the file does not exist. Throws
/// std::invalid_argument if it is not an image or has another size.
std::optional<sim::cameras::Image> read_image(const std::string& file, int width, int height);
/// Throws std::invalid_argument if the file cannot be written.
void write_image(const std::string& file, const sim::cameras::Image& image);

}  // namespace images
