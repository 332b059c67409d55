#pragma once
#include <map>
#include <string>

#include "components/gap_monitor/window.hpp"
#include "components/node/node.hpp"

/// Compares the running robot with its nominal model. Publishes the residuals of every stage on
/// `stage_residual`, and reports an event when a residual exceeds its noise floor or returns to it.
/// Sends no commands.
class GapMonitor {
 public:
  static constexpr bool in_background = true;
  struct Params {
    xml::Place place;
    std::string model;
    double window_s = 4;
    double every_s = 1;
    int consecutive = 2;
    void visit(auto& v) {
      v.former("times", "consecutive");
      v("model", model, "robot.xml to compare with, relative to the config; empty: the graph's.");
      v("window_s", window_s, {xml::Range{2, 60}, "Length of the evaluated window; chosen."});
      v("every_s", every_s, {xml::Range{0.2, 60}, "Period of the evaluation; chosen."});
      v("consecutive", consecutive,
        {xml::Range{1, 100},
         "Consecutive evaluations with the same result before an event is reported; chosen."});
    }
  };
  GapMonitor(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  struct StageState {
    int open_count = 0, closed_count = 0;  ///< consecutive evaluations with and without a gap
    bool reported = false;                 ///< the gap was reported as open
  };
  /// Reports missing sensor frames, once per silence.
  void report_silence();
  void evaluate();
  void publish(const std::vector<sim::diagnosis::StageGap>& gaps);
  void report(const sim::diagnosis::StageGap& gap);

  Params params_;
  node::Node& node_;
  gap_monitor::Window window_;
  node::Publisher<erp::StageResidual>& out_;
  erp::StageResidual message_;
  std::map<std::string, StageState> states_;
  std::int64_t last_evaluation_ns_ = 0;
  bool received_ = false, ever_received_ = false;  ///< a frame since the last check; any frame
  bool failure_reported_ = false, silence_reported_ = false;
};
