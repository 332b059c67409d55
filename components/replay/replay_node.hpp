#pragma once
#include <string>

#include "components/node/node.hpp"
#include "components/replay/frames.hpp"
#include "interfaces/robot/robot.hpp"

/// Acts as the device: publishes the ecu_frames of a recording at their recorded rate, or in
/// lockstep one per command. It receives commands but ignores their content.
namespace replay {

class ReplayNode {
 public:
  struct Params {
    std::string file;
    void visit(auto& v) {
      v("file", file,
        "Recording whose ecu_frames are published; the component does not start without it.");
    }
  };
  /// Throws if the recording is missing or contains no frames.
  static void check(const Params& params) { Frames frames(params.file); }
  static const char* role(const Params&) { return node::device_role; }
  ReplayNode(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  void play_due();
  void play_next();
  void publish_frame();

  node::Node& node_;
  Frames frames_;
  node::Publisher<erp::EcuFrame>& frame_out_;
  node::Publisher<erp::Clock>& clock_out_;
  std::size_t next_ = 0, end_;
  std::int64_t start_ns_ = 0, published_ns_ = 0, played_ns_ = 0;
  erp::EcuFrame frame_;
};

}  // namespace replay
