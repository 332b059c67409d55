#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>

#include "sim/learning/experience/feedback.hpp"
#include "sim/learning/experience/patterns.hpp"

/// One reach over time. The simulator without a bus and a live graph run the same code. Time is an
/// argument.
///
///   approach  the ECUs' length laws move the lines to the start and hold them there
///   pattern   the scaled voltage patterns, then zero voltage while the arm settles
///   correct   feedback on the offset of the hand
///   rest      zero voltage: the gears hold the shafts
///
/// Voltages are relative to the voltage that keeps each shaft still under its tension
/// (sim/control/motor_inverse.hpp): 0 holds the shaft, and the integral over time is the line wound
/// up.
namespace sim::experience {

struct ReachTimes {
  double approach_s = 1.5, hold_s = 0.5;
  double settle_s = 1.5, correct_s = 4;
  double mean_s = 0.1;
  double feedback_V = 3;
  void visit(auto& v) {
    v.former("way_s", "approach_s"), v.former("still_s", "hold_s");
    v("approach_s", approach_s,
      {xml::positive, "Time in which the lines move to the start; chosen."});
    v("hold_s", hold_s, {xml::positive, "Time at rest before the pattern; chosen."});
    v("settle_s", settle_s, {xml::positive, "Time at zero voltage after the pattern; chosen."});
    v("correct_s", correct_s, {xml::at_least_zero, "Time of feedback; 0: none; chosen."});
    v("mean_s", mean_s,
      {xml::positive, "Averaging time of the hand position at the end of a phase; chosen."});
    v("feedback_V", feedback_V,
      {xml::positive,
       "Limit of the feedback voltage of a drive; larger ones are scaled down; chosen."});
  }
};

/// A command to the muscles: line lengths in m, or voltages.
struct MuscleCommand {
  bool lengths = true;
  Eigen::VectorXd by_muscle;
};

class Reach {
 public:
  struct Plan {
    Eigen::VectorXd start_line_m;  ///< by muscle
    Eigen::VectorXd scales_Vs;     ///< by drive
    Eigen::Vector3d target_m;
    std::shared_ptr<const Feedback> feedback;  ///< nullptr: the phase `correct` is skipped
  };
  /// The reach begins at the first `step`. `drives` is muscles × drives.
  Reach(Patterns patterns, Eigen::MatrixXd drives, const ReachTimes& times, Plan plan);

  /// Returns the command for the current line lengths and, if known, the hand position. Times
  /// increase.
  MuscleCommand step(double time_s, const Eigen::VectorXd& line_m,
                     const std::optional<Eigen::Vector3d>& hand_m);

  bool done() const { return phase_ == Phase::rest; }
  const Plan& plan() const { return plan_; }
  /// Mean hand position at the end of each phase; nullopt if the hand was not visible.
  const std::optional<Eigen::Vector3d>& began_m() const { return at_start_m_; }
  const std::optional<Eigen::Vector3d>& settled_m() const { return at_settled_m_; }
  const std::optional<Eigen::Vector3d>& corrected_m() const { return at_corrected_m_; }
  bool limited() const { return is_limited_; }  ///< a feedback voltage was limited to `feedback_V`

 private:
  enum class Phase { approach, pattern, correct, rest };
  void next_phase();
  double phase_length_s() const;
  void track_hand(double time_s, const std::optional<Eigen::Vector3d>& hand_m);
  MuscleCommand lines_to_start(double phase_s) const;
  MuscleCommand correct();

  Patterns patterns_;
  Eigen::MatrixXd drives_;
  ReachTimes times_;
  Plan plan_;
  Phase phase_ = Phase::approach;
  double begin_s_ = 0, last_s_ = 0;
  bool is_running_ = false, is_limited_ = false;
  Eigen::VectorXd from_line_m_;
  Eigen::Vector3d sum_m_ = Eigen::Vector3d::Zero(), rate_m_per_s_ = Eigen::Vector3d::Zero();
  int count_ = 0;
  std::optional<Eigen::Vector3d> hand_m_, at_start_m_, at_settled_m_, at_corrected_m_;
};

}  // namespace sim::experience
