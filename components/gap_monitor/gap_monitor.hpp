#pragma once
#include <map>
#include <string>

#include "components/gap_monitor/window.hpp"
#include "components/node/node.hpp"

/// The nominal model beside the running robot: residuals of every stage on `stage_residual`, and an
/// event when a stage leaves its floor or comes back to it. It commands nothing.
class GapMonitor {
 public:
  static constexpr bool in_background = true;
  struct Params {
    xml::Place place;
    std::string model;    ///< robot.xml to hold the robot against; empty: the graph's
    double window_s = 4;  ///< of what is judged
    double every_s = 1;
    int times = 2;  ///< in a row, before an event is made of it
    void visit(auto& v) {
      v("model", model);
      v("window_s", window_s, xml::Range{2, 60});
      v("every_s", every_s, xml::Range{0.2, 60});
      v("times", times, xml::Range{1, 100});
    }
  };
  GapMonitor(const Params& params, const erp::Robot& robot, node::Node& node);

 private:
  struct Said {
    int open = 0, closed = 0;  ///< times in a row
    bool told = false;
  };
  /// Once for each silence.
  void tell_waiting();
  void judge();
  void publish(const std::vector<sim::diagnosis::StageGap>& gaps);
  void tell(const sim::diagnosis::StageGap& gap);

  Params params_;
  node::Node& node_;
  gap_monitor::Window window_;
  node::Publisher<erp::StageResidual>& out_;
  erp::StageResidual message_;
  std::map<std::string, Said> said_;
  std::int64_t judged_ns_ = 0;
  bool heard_ = false, ever_heard_ = false;  ///< a frame, lately and at all
  bool told_why_ = false, told_waiting_ = false;
};
