#pragma once
#include <deque>
#include <string>
#include <vector>

#include "interfaces/topics.hpp"
#include "sim/gap/diagnosis/localization.hpp"

/// The last seconds of a running robot, held against its model.
namespace gap_monitor {

class Window {
 public:
  /// Throws as sim::residuals::Stages.
  Window(const erp::Robot& model, double window_s);

  /// One that is stamped before the last is of another run, with which the window begins anew.
  void hear(const erp::SensorFrame& frame);
  /// For joints that sensor_frame does not carry: motion capture's, else the simulator's, never an
  /// estimate.
  void hear(const erp::JointState& state);

  bool full() const { return rows_.size() >= most_; }
  std::int64_t stamp_ns() const { return stamp_ns_; }  ///< of the last frame

  /// The window as a table, as a recording would give it.
  recording::Table table() const;
  /// Stages and their residuals over the window; nothing while it is not full, or where frames
  /// were lost in such numbers that it cannot be laid out, which `why` tells.
  std::vector<sim::diagnosis::StageGap> judge(std::string& why) const;

 private:
  erp::Robot model_;
  std::size_t most_;
  std::vector<std::string> columns_{"time_s", "sequence"};
  std::vector<double> joint_state_;  ///< of spherical joints, in the order of columns; NaN: told of
                                     ///< none since the last frame
  bool tracked_ = false;             ///< by motion capture
  std::deque<std::vector<double>> rows_;
  std::int64_t stamp_ns_ = 0;
};

}  // namespace gap_monitor
