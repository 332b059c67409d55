#pragma once
#include "components/images/film.hpp"
#include "components/images/spots.hpp"
#include "components/node/run.hpp"

/// Cameras that say where bright spots are in their images: image_point. The images are painted or
/// read from a folder (film.hpp).
namespace eye {

class Eye {
 public:
  static constexpr bool in_background = true;
  struct Params {
    xml::Place place;
    std::string view;  ///< cameras and markers, beside this file
    images::FilmParams film;
    images::SpotOptions spots;
    void visit(auto& v) {
      v.required("view", view);
      film.visit(v);
      v("threshold", spots.threshold, xml::Range{1, 254});
    }
  };

  /// Throws xml::Errors of the view, and what Film does.
  Eye(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  void see(const images::Film::Frame& frame, std::int64_t stamp_ns);

  images::SpotOptions spots_;
  sim::cameras::ViewConfig view_;
  node::Publisher<erp::ImagePoint>& out_;
  images::Film film_;  ///< last: it uses the others
};

}  // namespace eye
