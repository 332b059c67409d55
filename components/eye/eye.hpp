#pragma once
#include "components/images/image_source.hpp"
#include "components/images/spots.hpp"
#include "components/node/run.hpp"

/// Publishes the positions of bright spots in camera images: image_point. The images are rendered
/// or read from a folder (image_source.hpp).
namespace eye {

class Eye {
 public:
  static constexpr bool in_background = true;
  struct Params {
    xml::Place place;
    std::string view;
    images::ImageSourceParams image_params;
    images::SpotOptions spots;
    void visit(auto& v) {
      v.required("view", view,
                 "File of cameras and markers, a <camera_view>, relative to the config.");
      image_params.visit(v);
      v("threshold", spots.threshold,
        {xml::Range{1, 254}, "Brightness above which a pixel belongs to a spot, of 255; chosen."});
    }
  };

  /// Throws xml::Errors of the view, and as ImageSource does.
  Eye(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  void publish_spots(const images::ImageSource::Frame& frame, std::int64_t stamp_ns);

  images::SpotOptions spots_;
  sim::cameras::ViewConfig view_;
  node::Publisher<erp::ImagePoint>& out_;
  images::ImageSource image_source_;  ///< last, because it uses the other members
};

}  // namespace eye
