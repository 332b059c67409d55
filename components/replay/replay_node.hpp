#pragma once
#include <string>

#include "components/node/node.hpp"
#include "components/replay/frames.hpp"
#include "interfaces/robot/robot.hpp"

/// A recording plays the device: its ecu_frames at the pace they were recorded, or in lockstep one
/// for each command. It hears commands and follows none of them.
namespace replay {

class ReplayNode {
 public:
  struct Params {
    std::string file;  ///< the recording; must be given
    void visit(auto& v) { v("file", file); }
  };
  /// The recording is there and holds frames.
  static void check(const Params& params) { Frames frames(params.file); }
  ReplayNode(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  void play_due();
  void play_next();
  void say_frame();

  node::Node& node_;
  Frames frames_;
  node::Publisher<erp::EcuFrame>& frame_out_;
  node::Publisher<erp::Clock>& clock_out_;
  std::size_t next_ = 0, end_;
  std::int64_t recorded_start_ns_ = 0, began_ns_ = 0, said_ns_ = 0;
  erp::EcuFrame frame_;
};

}  // namespace replay
