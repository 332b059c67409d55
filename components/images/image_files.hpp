#pragma once
#include <optional>
#include <string>

#include "sim/model/cameras/images.hpp"

/// Images as files of eight bits a pixel.
namespace images {

/// <folder>/<camera>_00017.png
std::string image_name(const std::string& folder, const std::string& camera, std::uint64_t number);
/// Any format that OpenCV knows, as grey. Nothing: there is no such file. Throws std::invalid_argument
/// for one that is no image, or not of that size.
std::optional<sim::cameras::Image> read_image(const std::string& file, int width, int height);
/// Throws std::invalid_argument where it cannot be written.
void write_image(const std::string& file, const sim::cameras::Image& image);

}  // namespace images
