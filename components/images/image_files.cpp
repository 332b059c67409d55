#include "components/images/image_files.hpp"

#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace images {

std::string image_name(const std::string& folder, const std::string& camera, std::uint64_t number) {
  return fmt::format("{}/{}_{:05}.png", folder, camera, number);
}

std::optional<sim::cameras::Image> read_image(const std::string& file, int width, int height) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  const cv::Mat pixels = cv::imread(file, cv::IMREAD_GRAYSCALE);
  if (pixels.cols != width || pixels.rows != height)
    throw std::invalid_argument(fmt::format("{}: {} × {} pixels, the camera's images have {} × {}",
                                            file, pixels.cols, pixels.rows, width, height));
  sim::cameras::Image image{width, height, {}};
  image.pixels.reserve(pixels.total());
  for (int v = 0; v < height; ++v)
    image.pixels.insert(image.pixels.end(), pixels.ptr(v), pixels.ptr(v) + width);
  return image;
}

void write_image(const std::string& file, const sim::cameras::Image& image) {
  const cv::Mat pixels(image.height, image.width, CV_8UC1,
                       const_cast<std::uint8_t*>(image.pixels.data()));  // read only
  if (!cv::imwrite(file, pixels))
    throw std::invalid_argument(file + ": cannot be written; check that the folder exists");
}

}  // namespace images
