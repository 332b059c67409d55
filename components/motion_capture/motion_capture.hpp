#pragma once
#include <memory>

#include "components/joints/joints.hpp"
#include "components/motion_capture/capture.hpp"
#include "components/node/run.hpp"

/// Joints from two infrared cameras as a component: joint_state and body_pose of source
/// "motion_capture".
///
/// The images are painted, as the cameras would see the simulated robot (from the sim's
/// joint_state), or read from a folder: <camera>_00000.png, …, one pair a period.
namespace capture {

class MotionCapture {
 public:
  /// `<bone body="forearm" from_m="…" to_m="…" radius_m="…"/>`: hides the markers behind it.
  struct BoneConfig {
    static constexpr auto element = "bone";
    xml::Place place;
    std::string body;
    xml::Vec3 from_m{0, 0, 0}, to_m{0, 0, 0};
    double radius_m = 0.03;
    void visit(auto& v) {
      v.required("body", body);
      v.required("from_m", from_m), v.required("to_m", to_m);
      v("radius_m", radius_m, xml::positive);
    }
  };
  struct Params {
    xml::Place place;
    std::string images;  ///< a folder of image files, beside this file; "": painted
    std::string save;    ///< a folder that painted images are kept in; "": they are not
    double period_s = 0.01;
    int seed = 1;           ///< of the noise
    double ball_m = 0.007;  ///< a marker's radius
    double noise = 4;       ///< of a pixel, of 255
    CaptureOptions options;
    std::vector<sim::cameras::CameraConfig> cameras;  ///< left, right
    std::vector<MarkerConfig> markers;
    std::vector<BoneConfig> bones;
    void visit(auto& v) {
      v("images", images), v("save", save);
      v("period_s", period_s, xml::positive);
      v("seed", seed, xml::Range{0, 1e9});
      v("ball_m", ball_m, xml::positive);
      v("noise", noise, xml::at_least_zero);
      v("threshold", options.spots.threshold, xml::Range{1, 254});
      v("gap_m", options.stereo.gap_m, xml::positive);
      v("gate_m", options.gate_m, xml::positive);
      v("lost_m", options.lost_m, xml::positive);
      v.list(cameras), v.list(markers), v.list(bones);
    }
  };

  /// Throws std::invalid_argument: not two cameras, a marker or a bone on a body there is not.
  MotionCapture(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  struct Bone {
    std::size_t body;
    sim::cameras::Bone bone;
  };
  using Pair = std::array<sim::cameras::Image, 2>;
  void paint(const erp::JointState& truth);
  void read_files();
  void keep(const Pair& pair);
  void see(const Pair& pair, std::uint64_t sequence, std::int64_t stamp_ns);
  void tell_change();
  void publish(const Captured& found, std::uint64_t sequence, std::int64_t stamp_ns);

  Params params_;
  node::Node& node_;
  joints::Names names_;
  Capture capture_;
  std::vector<Bone> bones_;
  std::vector<sim::cameras::Painter> painters_;
  node::Publisher<erp::JointState>& joints_out_;
  node::Publisher<erp::BodyPose>& bodies_out_;
  std::vector<sim::JointReading> truth_;
  Pair pair_;
  std::int64_t painted_ns_ = 0;
  std::optional<std::int64_t> seen_ns_;
  std::uint64_t images_ = 0;
  bool was_lost_ = true;
};

}  // namespace capture
