#pragma once
#include <optional>
#include <string>

#include "components/node/run.hpp"
#include "sim/learning/sensorimotor/experiment.hpp"
#include "sim/learning/sensorimotor/eye.hpp"

/// Learns reaching in a camera image on the live graph (paper, 5.4 and Fig. 9): twitches, then
/// trials at each goal; or only trials, with a map learned before.
///
/// Muscles at rest pull with robot.xml's pretension; the forces of the map are added to it, as
/// references of the ECUs' force laws. After the last goal the muscles rest. The map is written
/// after each goal.
namespace control {

class Sensorimotor {
 public:
  struct Params {
    xml::Place place;
    sim::sensorimotor::Experiment experiment;
    std::string learned;
    std::string save;
    std::string source = "eye";
    double stale_s = 0.1;
    void visit(auto& v) {
      experiment.visit(v);
      v.former("learnt", "learned");
      v("stale_s", stale_s,
        {xml::positive,
         "Age relative to the sensor frame from which images are rejected; chosen."});
      v("learned", learned,
        "Initial map, a <sensorimotor_learned>, relative to the config; with it there are no "
        "twitches; empty: none.");
      v("save", save, "File to which the map is written after each goal; empty: none.");
      v("source", source, "Component whose image_point is used.");
    }
  };

  /// Throws xml::Errors of the view and of the map, std::invalid_argument as Eye and learned_map_of
  /// do.
  Sensorimotor(const Params& params, const erp::Robot& robot, node::Node& node);

  bool accepts(const erp::ImagePoint& points) const { return params_.source == points.source; }
  erp::ActuatorCommand step(const erp::SensorFrame& frame, double dt_s,
                            const node::Latest<erp::ImagePoint>& points);

 private:
  void on_image(const erp::ImagePoint& points);
  void report_progress();
  void save_map() const;

  Params params_;
  const erp::Robot& robot_;
  node::Node& node_;
  sim::sensorimotor::Eye eye_;
  sim::sensorimotor::Session session_;
  double time_s_ = 0;
  std::int64_t last_image_ns_ = 0;
  std::size_t goals_reported_ = 0;
  bool done_reported_ = false, unseen_reported_ = false, limited_reported_ = false;
};

}  // namespace control
