#pragma once
#include <optional>
#include <string>
#include <vector>

#include "components/node/run.hpp"
#include "sim/synergy/bank_file.hpp"

/// Striking targets by motor plans of a bank (paper, 5.5): open loop, target after target, each from
/// the lengths that lines had at the start.
///
/// Where somebody says where the hand's body is, each trial is judged, and the bank learns from it: its
/// contributors are credited, and the plan is stored with the place to which it brought the hand.
namespace control {

/// `<target at_m="0.35 -0.2 0.1"/>`: a bottle's middle, in the world.
struct StrikeTarget {
  static constexpr auto element = "target";
  xml::Place place;
  xml::Vec3 at_m{};
  void visit(auto& v) { v.required("at_m", at_m); }
};

class Synergy {
 public:
  struct Params {
    xml::Place place;
    std::string bank;  ///< bank.xml of `erp learn synergy`, beside this file
    std::string save;  ///< where the bank goes as it learns, "": nowhere, and it does not learn
    std::string source = "sim";  ///< whose body_pose says where the hand is
    double stale_s = 0.05;       ///< older ones do not; chosen
    double noise = 0;            ///< deviation of signal-dependent noise that is added, a share
    int seed = 1;                ///< of that
    std::vector<StrikeTarget> targets;
    void visit(auto& v) {
      v.required("bank", bank);
      v("save", save);
      v("source", source);
      v("stale_s", stale_s, xml::positive);
      v("noise", noise, xml::Range{0, 1});
      v("seed", seed, xml::Range{0, 1e9});
      v.list(targets);
    }
  };

  /// Throws xml::Errors of the bank, std::invalid_argument as its `check` and actuators_of do.
  Synergy(const Params& params, const erp::Robot& robot, node::Node& node);

  bool wants(const erp::BodyPose& bodies) const { return params_.source == bodies.source; }
  erp::ActuatorCommand step(const erp::SensorFrame& frame, double dt_s,
                            const node::Latest<erp::BodyPose>& bodies);

 private:
  void read(const erp::SensorFrame& frame);
  std::optional<sim::Vec3> hand_m(const node::Latest<erp::BodyPose>& bodies) const;
  void begin();
  void end();
  void begin_watching(const sim::Vec3& hand_m);
  void learn(const sim::synergy::Outcome& outcome, const sim::Vec3& target_m);
  erp::ActuatorCommand command(const Eigen::VectorXd& line_m) const;

  Params params_;
  erp::Robot robot_;
  node::Node& node_;
  sim::synergy::BankFile file_;
  sim::synergy::Bank bank_;
  std::vector<std::size_t> muscles_;
  std::vector<double> all_line_m_;  ///< by actuator
  Eigen::VectorXd line_m_;          ///< by learnt muscle
  std::optional<sim::synergy::Trial> trial_;
  std::vector<double> credits_;
  bool watched_ = false;    ///< the plan has begun and the hand was seen
  bool displaced_ = false;  ///< then, elsewhere than plans were learnt to begin
  bool seen_ = true;        ///< the hand, since the plan began, all the time
  std::size_t target_ = 0;
  int judged_ = 0, struck_ = 0;
  double time_s_ = 0;
};

}  // namespace control
