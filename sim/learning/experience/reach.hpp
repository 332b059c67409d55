#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>

#include "sim/learning/experience/feedback.hpp"
#include "sim/learning/experience/patterns.hpp"

/// One reach as it goes on in time; the same in the simulator without a bus and on a live graph. Pure:
/// time is an argument.
///
///   way      lines are led to those of the start, by the ECUs' length laws, and rest there
///   pattern  the scaled voltage patterns, then no voltage while the arm settles
///   correct  feedback on what the hand is off
///   rest     no voltage: gears hold
///
/// Voltages are those beyond what each shaft needs to stand still under its tension
/// (sim/control/motor_inverse.hpp), so that 0 holds still and the sum over time is what is wound up.
namespace sim::experience {

struct ReachTimes {
  double way_s = 1.5, still_s = 0.5;     ///< chosen
  double settle_s = 1.5, correct_s = 4;  ///< chosen
  double mean_s = 0.1;                   ///< of the hand's place, at the end of each; chosen
  double feedback_V = 3;  ///< no drive is given more by feedback: scaled down; chosen
  void visit(auto& v) {
    v("way_s", way_s, xml::positive);
    v("still_s", still_s, xml::positive);
    v("settle_s", settle_s, xml::positive);
    v("correct_s", correct_s, xml::at_least_zero);
    v("mean_s", mean_s, xml::positive);
    v("feedback_V", feedback_V, xml::positive);
  }
};

/// What muscles are asked: lengths of lines, m, or voltages.
struct Wanted {
  bool lengths = true;
  Eigen::VectorXd by_muscle;
};

class Reach {
 public:
  struct Plan {
    Eigen::VectorXd start_line_m;  ///< by muscle
    Eigen::VectorXd scales_Vs;     ///< by drive
    Eigen::Vector3d target_m;
    std::shared_ptr<const Feedback> feedback;  ///< none: there is no phase `correct`
  };
  /// Begins at its first `step`. `drives` muscles × drives.
  Reach(Patterns patterns, Eigen::MatrixXd drives, const ReachTimes& times, Plan plan);

  /// Lines as they are now, and the hand where it is known. Times rise.
  Wanted step(double time_s, const Eigen::VectorXd& line_m,
              const std::optional<Eigen::Vector3d>& hand_m);

  bool done() const { return phase_ == Phase::rest; }
  const Plan& plan() const { return plan_; }
  /// Where the hand was, on average, at the end of each phase; nothing: not known then.
  const std::optional<Eigen::Vector3d>& began_m() const { return began_; }
  const std::optional<Eigen::Vector3d>& settled_m() const { return settled_; }
  const std::optional<Eigen::Vector3d>& corrected_m() const { return corrected_; }
  bool limited() const { return limited_; }  ///< feedback asked for more than the most

 private:
  enum class Phase { way, pattern, correct, rest };
  void next();
  double length_s() const;
  void watch(double time_s, const std::optional<Eigen::Vector3d>& hand_m);
  Wanted lead(double into_s) const;
  Wanted correct();

  Patterns patterns_;
  Eigen::MatrixXd drives_;
  ReachTimes times_;
  Plan plan_;
  Phase phase_ = Phase::way;
  double begin_s_ = 0, last_s_ = 0;
  bool begun_ = false, limited_ = false;
  Eigen::VectorXd from_line_m_;
  Eigen::Vector3d sum_m_ = Eigen::Vector3d::Zero(), rate_m_per_s_ = Eigen::Vector3d::Zero();
  int count_ = 0;
  std::optional<Eigen::Vector3d> hand_m_, began_, settled_, corrected_;
};

}  // namespace sim::experience
