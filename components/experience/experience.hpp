#pragma once
#include <optional>
#include <string>
#include <vector>

#include "components/joints/joints.hpp"
#include "components/node/run.hpp"
#include "sim/learning/experience/base_file.hpp"
#include "sim/learning/experience/motors.hpp"
#include "sim/model/skeleton/skeleton_model.hpp"

/// Reaching with stored experiences (paper, 5.6 and Fig. 11): for each goal, a voltage pattern from
/// the nearest start, then feedback on the offset of the hand.
///
/// The hand position follows from the joints. While they are unknown there is no correction: the
/// voltage only holds the tension, and the gears hold the arm. Each reach is added to the base.
namespace control {

/// `<goal at_m="0.3 -0.2 -0.5"/>`: position in the world.
struct ReachGoal {
  static constexpr auto element = "goal";
  static constexpr auto description = "Position to reach; the goals are reached in sequence.";
  xml::Place place;
  xml::Vec3 at_m{};
  void visit(auto& v) { v.required("at_m", at_m, "Position in the world that the hand reaches."); }
};

class Experience {
 public:
  struct Params {
    xml::Place place;
    std::string base;
    sim::experience::FeedbackKind feedback = sim::experience::FeedbackKind::linear;
    double feedback_gain_per_s = 1.5;
    std::string rules;
    std::string save;
    std::string source = "sim";
    double stale_s = 0.05;
    std::vector<ReachGoal> goals;
    void visit(auto& v) {
      v.former("closing_per_s", "feedback_gain_per_s");
      v.required("base", base,
                 "Stored experiences, an <experience_base> of erp learn experience, relative to "
                 "the config.");
      v("feedback", feedback,
        "Feedback on the offset of the hand after the voltage pattern: linear, fuzzy (with rules) "
        "or none.");
      v("feedback_gain_per_s", feedback_gain_per_s, {xml::positive, "Gain b of linear feedback."});
      v("rules", rules,
        "Rules of fuzzy feedback in the FuzzyLite language, relative to the config; empty: none.");
      v("save", save, "File to which the extended base is written; empty: none.");
      v("source", source,
        "Component whose joint_state is used: sim, pose_estimator or motion_capture.");
      v("stale_s", stale_s, {xml::positive, "Age from which joint states are rejected; chosen."});
      v.list(goals);
    }
  };

  /// Throws xml::Errors of the base, std::invalid_argument as its `check` and Hand do.
  Experience(const Params& params, const erp::Robot& robot, node::Node& node);

  bool accepts(const erp::JointState& state) const { return params_.source == state.source; }
  erp::ActuatorCommand step(const erp::SensorFrame& frame, double dt_s,
                            const node::Latest<erp::JointState>& joints);

 private:
  void read_measurements(const erp::SensorFrame& frame);
  std::optional<sim::Vec3> hand_m(const erp::SensorFrame& frame,
                                  const node::Latest<erp::JointState>& joints);
  int nearest_start() const;
  void begin_reach();
  void end_reach();
  void report_reached();
  void save_base() const;
  erp::ActuatorCommand command(const sim::experience::MuscleCommand& desired) const;

  Params params_;
  erp::Robot robot_;
  node::Node& node_;
  joints::Names names_;
  sim::SkeletonModel skeleton_;
  sim::experience::BaseFile file_;
  sim::experience::Base base_;
  sim::Hand hand_;
  sim::experience::Motors motors_;
  std::optional<sim::experience::Reach> reach_;
  std::vector<sim::JointReading> joints_;
  Eigen::VectorXd line_m_, tension_N_;
  std::size_t goal_ = 0;
  int start_ = 0;
  double time_s_ = 0;
  bool unknown_reported_ = false;
};

}  // namespace control
