#pragma once
#include <optional>
#include <string>

#include "components/node/run.hpp"
#include "sim/learning/sensorimotor/experiment.hpp"
#include "sim/learning/sensorimotor/eye.hpp"

/// Reaching in a camera's image, learnt on the live graph (paper, 5.4 and Fig. 9): twitches, then
/// tries at each goal; or tries alone, with what was learnt before.
///
/// Muscles at rest pull with robot.xml's pretension; what is learnt comes on top, by the ECUs' force
/// laws. When all is done they rest. What is learnt is written after each goal.
namespace control {

class Sensorimotor {
 public:
  struct Params {
    xml::Place place;
    sim::sensorimotor::Experiment experiment;
    std::string learnt;          ///< learnt.xml to begin with, beside this file: no twitches then
    std::string save;            ///< where what is learnt goes; "": nowhere
    std::string source = "eye";  ///< whose image_point is believed
    double stale_s = 0.1;        ///< of images older than the frame by more nothing is seen; chosen
    void visit(auto& v) {
      experiment.visit(v);
      v("stale_s", stale_s, xml::positive);
      v("learnt", learnt);
      v("save", save);
      v("source", source);
    }
  };

  /// Throws xml::Errors of the view and of what was learnt, std::invalid_argument as Eye and
  /// learnt_of do.
  Sensorimotor(const Params& params, const erp::Robot& robot, node::Node& node);

  bool wants(const erp::ImagePoint& points) const { return params_.source == points.source; }
  erp::ActuatorCommand step(const erp::SensorFrame& frame, double dt_s,
                            const node::Latest<erp::ImagePoint>& points);

 private:
  void see(const erp::ImagePoint& points);
  void tell();
  void write() const;

  Params params_;
  const erp::Robot& robot_;
  node::Node& node_;
  sim::sensorimotor::Eye eye_;
  sim::sensorimotor::Session session_;
  double time_s_ = 0;
  std::int64_t seen_ns_ = 0;
  std::size_t goals_told_ = 0;
  bool done_told_ = false, blind_told_ = false, limited_told_ = false;
};

}  // namespace control
