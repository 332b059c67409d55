#pragma once
#include <optional>
#include <string>
#include <vector>

#include "components/node/run.hpp"
#include "sim/learning/synergy/bank_file.hpp"

/// Striking targets by motor plans of a bank (paper, 5.5): open loop, target after target, each from
/// the lengths that lines had at the start.
///
/// Where somebody says where the hand's body is, each trial is judged, and the bank learns from it as
/// in the lesson; and no plan begins while the hand is not where plans were learnt to begin: bones that
/// only muscles hold may rest otherwise with the same lines, and plans would lead elsewhere.
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
  void lead_back(double dt_s);
  void watch(const std::optional<sim::Vec3>& hand_m);
  bool in_place(const std::optional<sim::Vec3>& hand_m);
  void begin();
  void end();
  void tell(const sim::synergy::Taught& taught);
  void learn(sim::synergy::Taught taught);
  std::string target() const { return "target " + std::to_string(target_ + 1); }
  erp::ActuatorCommand command(const Eigen::VectorXd& line_m) const;

  Params params_;
  erp::Robot robot_;
  node::Node& node_;
  sim::synergy::BankFile file_;
  sim::synergy::Bank bank_;
  std::vector<std::size_t> muscles_;
  std::vector<double> all_line_m_;            ///< by actuator
  Eigen::VectorXd line_m_, start_m_;          ///< by learnt muscle; at the start
  std::optional<sim::synergy::WayBack> way_;  ///< before the first target, and after a gap
  std::optional<sim::synergy::Trial> trial_;
  std::vector<double> credits_;
  bool seen_ = true;      ///< the hand, since the trial began, all the time
  bool waiting_ = false;  ///< for the hand to be where plans begin
  std::size_t target_ = 0;
  int judged_ = 0, struck_ = 0;
  double time_s_ = 0;
  bool begun_ = false;
};

}  // namespace control
