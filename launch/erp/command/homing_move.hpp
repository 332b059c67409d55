#pragma once
#include <deque>
#include <iosfwd>
#include <string>
#include <vector>

#include "launch/erp/command/robot_link.hpp"
#include "sim/world/homing_estimate.hpp"

/// Winds lines of a running robot gently, through its plant, and takes snapshots for
/// sim::HomingEstimate.
namespace launch {

using Names = std::vector<std::string>;

class HomingMove {
 public:
  static constexpr double ramp_s = 2, hold_s = 4;  ///< chosen; hold_s includes the ramp

  /// `actuators`: those that move.
  HomingMove(RobotLink& link, const erp::Robot& robot, Names actuators, int priority)
      : link_(link), model_(robot), names_(std::move(actuators)), priority_(priority) {}

  /// One tension in every line; the snapshot at rest. Throws std::runtime_error with the reason if the
  /// robot does not rest, if a line is slack, or if an actuator does not follow; then releases.
  sim::HomingSnapshot rest(double tension_N);
  /// One set of tensions after the other, by actuator of robot.xml; a snapshot at the end of each.
  /// Prints the progress.
  std::vector<sim::HomingSnapshot> follow(const std::vector<std::vector<double>>& sets,
                                          std::ostream& out);
  /// Commands the last tensions again; to be called at least every 20 ms.
  void hold();
  void release();

 private:
  sim::HomingSnapshot pass(const std::vector<double>& tension_N, bool until_rest);
  sim::HomingSnapshot measure() const;
  sim::HomingSnapshot mean() const;
  double moved_m() const;
  void send(const std::vector<double>& tension_N);
  std::string obstacle() const;
  std::string slack_line(const sim::HomingSnapshot& snapshot) const;

  struct Row {
    std::int64_t time_ns;
    sim::HomingSnapshot snapshot;
  };
  RobotLink& link_;
  const erp::Robot& model_;
  Names names_;
  int priority_;
  std::vector<double> last_N_;
  std::deque<Row> rows_;  ///< of the last second
};

}  // namespace launch
