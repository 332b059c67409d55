#pragma once
#include <optional>
#include <string>
#include <vector>

#include "components/node/run.hpp"
#include "sim/learning/synergy/bank_file.hpp"

/// Strikes targets one after the other with the motor plans of a bank (paper, 5.5), open loop. Each
/// plan starts from the initial line lengths.
///
/// If the pose of the hand's body is known, each trial is evaluated, and the bank learns from it as
/// in the training. No plan begins while the hand is away from the start position of the training:
/// bones that are held only by muscles may rest at another position with the same line lengths, and
/// plans would miss.
namespace control {

/// `<target at_m="0.35 -0.2 0.1"/>`: the centre of a bottle, in the world.
struct StrikeTarget {
  static constexpr auto element = "target";
  static constexpr auto description = "Bottle to strike; the targets are struck in sequence.";
  xml::Place place;
  xml::Vec3 at_m{};
  void visit(auto& v) { v.required("at_m", at_m, "Centre of the bottle in the world."); }
};

class Synergy {
 public:
  struct Params {
    xml::Place place;
    std::string bank;
    std::string save;
    std::string source = "sim";
    double stale_s = 0.05;
    double noise = 0;
    int seed = 1;
    std::vector<StrikeTarget> targets;
    void visit(auto& v) {
      v.required("bank", bank,
                 "Motor plans, a <synergy_bank> of erp learn synergy, relative to the config.");
      v("save", save, "File to which the bank is written as it learns; empty: no learning.");
      v("source", source, "Component whose body_pose gives the hand: sim or motion_capture.");
      v("stale_s", stale_s, {xml::positive, "Age from which body poses are rejected; chosen."});
      v("noise", noise,
        {xml::Range{0, 1},
         "Relative standard deviation of signal-dependent noise that is added to the plans; 0: "
         "none."});
      v("seed", seed, {xml::Range{0, 1e9}, "Seed of the noise."});
      v.list(targets);
    }
  };

  /// Throws xml::Errors of the bank, std::invalid_argument as its `check` and actuators_of do.
  Synergy(const Params& params, const erp::Robot& robot, node::Node& node);

  bool accepts(const erp::BodyPose& bodies) const { return params_.source == bodies.source; }
  erp::ActuatorCommand step(const erp::SensorFrame& frame, double dt_s,
                            const node::Latest<erp::BodyPose>& bodies);

 private:
  void read_lines(const erp::SensorFrame& frame);
  std::optional<sim::Vec3> hand_m(const node::Latest<erp::BodyPose>& bodies) const;
  void begin_return(double dt_s);
  void track_hand(const std::optional<sim::Vec3>& hand_m);
  bool is_at_start(const std::optional<sim::Vec3>& hand_m);
  void begin_trial();
  void end_trial();
  void report_result(const sim::synergy::TrialResult& result);
  void learn(sim::synergy::TrialResult result);
  std::string target() const { return "target " + std::to_string(target_ + 1); }
  erp::ActuatorCommand command(const Eigen::VectorXd& line_m) const;

  Params params_;
  erp::Robot robot_;
  node::Node& node_;
  sim::synergy::BankFile file_;
  sim::synergy::Bank bank_;
  std::vector<std::size_t> muscles_;
  std::vector<double> all_line_m_;    ///< by actuator
  Eigen::VectorXd line_m_, start_m_;  ///< by learned muscle: measured; initial
  std::optional<sim::synergy::ReturnPath>
      return_path_;  ///< return before the first target and after a gap
  std::optional<sim::synergy::Trial> trial_;
  std::vector<double> credits_;
  bool hand_was_known_ = true;  ///< the hand position was known throughout the trial
  bool displaced_ = false;      ///< the hand is away from the start position
  std::size_t target_ = 0;
  int evaluated_ = 0, struck_ = 0;
  double time_s_ = 0;
  bool has_begun_ = false;
};

}  // namespace control
