#include "components/eye/eye.hpp"

#include <filesystem>

namespace eye {
namespace {

sim::cameras::ViewConfig view_of(const Eye::Params& params) {
  const auto folder = std::filesystem::path(params.place.file).parent_path();
  return xml::read<sim::cameras::ViewConfig>((folder / params.view).string());
}

}  // namespace

Eye::Eye(const Params& params, const erp::Robot& robot, node::Node& node)
    : spots_(params.spots),
      view_(view_of(params)),
      out_(node.advertise<erp::ImagePoint>()),
      image_source_(params.image_params, view_, params.place.file, robot, node,
                    [this](const auto& frame, std::uint64_t, std::int64_t stamp_ns) {
                      publish_spots(frame, stamp_ns);
                    }) {}

void Eye::publish_spots(const images::ImageSource::Frame& frame, std::int64_t stamp_ns) {
  erp::ImagePoint message;
  message.stamp_ns = stamp_ns;
  for (std::size_t c = 0; c < frame.size(); ++c)
    for (const images::Spot& spot : images::find_spots(frame[c], spots_)) {
      if (message.points._length == erp::capacity_of<erp::ImagePointSample>) break;
      erp::ImagePointSample point{};
      erp::assign(point.camera, view_.cameras[c].name);
      point.u_px = spot.centre.x(), point.v_px = spot.centre.y(), point.area_px = spot.area_px;
      erp::append(message.points, point);
    }
  out_.publish(message);
}

}  // namespace eye
