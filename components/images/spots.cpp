#include "components/images/spots.hpp"

#include <opencv2/imgproc.hpp>

namespace images {
namespace {

/// Centre of brightness of the pixels in and around the box that exceed half the threshold.
Spot centred(const cv::Mat& image, const cv::Rect& box, double area_px, int threshold) {
  const cv::Rect wide = cv::Rect(box.x - 2, box.y - 2, box.width + 4, box.height + 4) &
                        cv::Rect(0, 0, image.cols, image.rows);
  double sum = 0, u = 0, v = 0;
  for (int y = wide.y; y < wide.y + wide.height; ++y)
    for (int x = wide.x; x < wide.x + wide.width; ++x) {
      const double bright = std::max(0, image.at<std::uint8_t>(y, x) - threshold / 2);
      sum += bright, u += bright * x, v += bright * y;
    }
  const bool at_edge = box.x == 0 || box.y == 0 || box.x + box.width == image.cols ||
                       box.y + box.height == image.rows;
  return {{u / sum, v / sum}, area_px, at_edge};
}

}  // namespace

std::vector<Spot> find_spots(const sim::cameras::Image& image, const SpotOptions& options) {
  const cv::Mat whole(image.height, image.width, CV_8UC1,
                      const_cast<std::uint8_t*>(image.pixels.data()));  // read only
  cv::Mat bright, labels, stats, centres;
  cv::threshold(whole, bright, options.threshold, 255, cv::THRESH_BINARY);
  const cv::Rect lit = cv::boundingRect(bright);  // usually a small part of the image; saves time
  if (lit.empty()) return {};
  const int count =
      cv::connectedComponentsWithStats(bright(lit), labels, stats, centres, 8, CV_32S);
  std::vector<Spot> spots;
  for (int k = 1; k < count; ++k) {  // 0 is the background
    const double area_px = stats.at<int>(k, cv::CC_STAT_AREA);
    if (area_px < options.least_px || area_px > options.most_px) continue;
    spots.push_back(centred(
        whole,
        {lit.x + stats.at<int>(k, cv::CC_STAT_LEFT), lit.y + stats.at<int>(k, cv::CC_STAT_TOP),
         stats.at<int>(k, cv::CC_STAT_WIDTH), stats.at<int>(k, cv::CC_STAT_HEIGHT)},
        area_px, options.threshold));
  }
  return spots;
}

}  // namespace images
