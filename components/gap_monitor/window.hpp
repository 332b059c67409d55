#pragma once
#include <deque>
#include <string>
#include <vector>

#include "interfaces/topics.hpp"
#include "sim/gap/diagnosis/localization.hpp"

/// The last seconds of a running robot, compared with its model.
namespace gap_monitor {

class Window {
 public:
  /// Throws as sim::residuals::Stages.
  Window(const erp::Robot& model, double window_s);

  /// Adds a frame. A frame with an earlier stamp than the last belongs to a new run and clears the
  /// window.
  void receive(const erp::SensorFrame& frame);
  /// Positions of spherical joints, which sensor_frame lacks: those of motion capture if it runs,
  /// else of the simulator. Those of an estimator are ignored.
  void receive(const erp::JointState& state);

  bool full() const { return rows_.size() >= max_rows_; }
  std::int64_t stamp_ns() const { return stamp_ns_; }  ///< of the last frame

  /// The window as a table with the columns of a recording.
  recording::Table table() const;
  /// Stages and their residuals over the window. Empty while the window is not full, or if it
  /// cannot be evaluated, for example after too many lost frames; `reason` then explains it.
  std::vector<sim::diagnosis::StageGap> evaluate(std::string& reason) const;

 private:
  erp::Robot model_;
  std::size_t max_rows_;
  std::vector<std::string> columns_{"time_s", "sequence"};
  /// Positions of spherical joints, by column; NaN: not received since the last frame.
  std::vector<double> joint_state_;
  bool tracked_ = false;  ///< motion capture has published joints
  std::deque<std::vector<double>> rows_;
  std::int64_t stamp_ns_ = 0;
};

}  // namespace gap_monitor
