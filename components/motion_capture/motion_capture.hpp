#pragma once
#include <memory>

#include "components/images/image_source.hpp"
#include "components/joints/joints.hpp"
#include "components/motion_capture/capture.hpp"
#include "components/node/run.hpp"

/// Motion capture with two infrared cameras as a component: joint_state and body_pose of source
/// "motion_capture".
///
/// The images are rendered or read from a folder: image_source.hpp.
namespace capture {

class MotionCapture {
 public:
  static constexpr bool in_background = true;
  struct Params {
    xml::Place place;
    images::ImageSourceParams image_params;
    CaptureOptions options;
    sim::cameras::ViewConfig view;
    void visit(auto& v) {
      image_params.visit(v);
      v("threshold", options.spots.threshold,
        {xml::Range{1, 254}, "Brightness above which a pixel belongs to a spot, of 255; chosen."});
      v("gap_m", options.stereo.gap_m,
        {xml::positive, "Largest distance of the rays of two spots that match; chosen."});
      v("gate_m", options.gate_m,
        {xml::positive, "Largest distance of a marker from its predicted position; chosen."});
      v("lost_m", options.lost_m, {xml::positive, "Largest RMS residual of a valid fit; chosen."});
      view.visit(v);
    }
  };

  /// Throws std::invalid_argument unless there are two cameras and the bodies of all markers and
  /// bones exist.
  MotionCapture(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  void on_images(const images::ImageSource::Frame& pair, std::uint64_t sequence,
                 std::int64_t stamp_ns);
  void report_change();
  void publish(const Captured& found, std::uint64_t sequence, std::int64_t stamp_ns);

  Params params_;
  node::Node& node_;
  joints::Names names_;
  Capture capture_;
  node::Publisher<erp::JointState>& joints_out_;
  node::Publisher<erp::BodyPose>& bodies_out_;
  node::Interval interval_;
  bool is_first_ = true, was_lost_ = true;
  images::ImageSource image_source_;  ///< last, because it uses the other members
};

}  // namespace capture
