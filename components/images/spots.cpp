#include "components/images/spots.hpp"

#include <opencv2/imgproc.hpp>

namespace images {
namespace {

/// Centre of brightness of the pixels in and around the box that exceed half the threshold.
Spot measure_spot(const cv::Mat& image, const cv::Rect& box, double area_px, int threshold) {
  constexpr int margin_px = 2;  // chosen: includes the dim edge of the spot
  const cv::Rect wide_box = cv::Rect(box.x - margin_px, box.y - margin_px,
                                     box.width + 2 * margin_px, box.height + 2 * margin_px) &
                            cv::Rect(0, 0, image.cols, image.rows);
  double sum = 0, u = 0, v = 0;
  for (int y = wide_box.y; y < wide_box.y + wide_box.height; ++y)
    for (int x = wide_box.x; x < wide_box.x + wide_box.width; ++x) {
      const double weight = std::max(0, image.at<std::uint8_t>(y, x) - threshold / 2);
      sum += weight, u += weight * x, v += weight * y;
    }
  const bool at_edge = box.x == 0 || box.y == 0 || box.x + box.width == image.cols ||
                       box.y + box.height == image.rows;
  return {{u / sum, v / sum}, area_px, at_edge};
}

}  // namespace

std::vector<Spot> find_spots(const sim::cameras::Image& image, const SpotOptions& options) {
  const cv::Mat pixels(image.height, image.width, CV_8UC1,
                       const_cast<std::uint8_t*>(image.pixels.data()));  // read only
  cv::Mat bright, labels, stats, centres;
  cv::threshold(pixels, bright, options.threshold, 255, cv::THRESH_BINARY);
  const cv::Rect bright_box = cv::boundingRect(bright);  // only this part is searched, to save time
  if (bright_box.empty()) return {};
  const int count =
      cv::connectedComponentsWithStats(bright(bright_box), labels, stats, centres, 8, CV_32S);
  std::vector<Spot> spots;
  for (int k = 1; k < count; ++k) {  // 0 is the background
    const double area_px = stats.at<int>(k, cv::CC_STAT_AREA);
    if (area_px < options.min_area_px || area_px > options.max_area_px) continue;
    spots.push_back(
        measure_spot(pixels,
                     {bright_box.x + stats.at<int>(k, cv::CC_STAT_LEFT),
                      bright_box.y + stats.at<int>(k, cv::CC_STAT_TOP),
                      stats.at<int>(k, cv::CC_STAT_WIDTH), stats.at<int>(k, cv::CC_STAT_HEIGHT)},
                     area_px, options.threshold));
  }
  return spots;
}

}  // namespace images
