#pragma once
#include <string>

#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/plural.hpp"
#include "interfaces/xml/xml.hpp"
#include "sim/model/skeleton/hand.hpp"
#include "sim/learning/synergy/bank.hpp"
#include "sim/learning/synergy/strike.hpp"
#include "sim/learning/synergy/trial.hpp"

/// All that a trial needs, as a file: `<synergy_bank>`.
namespace sim::synergy {

/// `<learnt muscle="right_biceps"/>`: a muscle that plans have a weight for; the others stay as long as
/// they are.
struct LearntMuscle {
  static constexpr auto element = "learnt", plural = "muscles";
  xml::Place place;
  std::string muscle;
  void visit(auto& v) { v.required("muscle", muscle); }
};
struct PlanRow {
  static constexpr auto element = "plan", plural = "plans";
  xml::Place place;
  xml::Vec3 at_m{};
  double value = 1, rise_s = 0.8, beyond = 0;
  std::vector<double> weights_m;
  void visit(auto& v) {
    v.required("at_m", at_m);
    v("value", value, xml::at_least_zero);
    v.required("rise_s", rise_s, xml::positive);
    v("beyond", beyond);
    v.required("weights_m", weights_m);
  }
};
struct BankFile {
  static constexpr auto element = "synergy_bank";
  xml::Place place;
  int rounds = 0;  ///< of the lesson that wrote it
  std::string seed;
  xml::Vec3 rest_m{};  ///< where the hand is before a trial, in the world
  BankOptions options;
  TrialTimes times;
  HandConfig hand;
  BottleConfig bottle;
  xml::Plural<LearntMuscle> muscles;
  xml::Plural<PlanRow> plans;
  void visit(auto& v) {
    v("rounds", rounds);
    v("seed", seed);
    v.required("rest_m", rest_m);
    options.visit(v);
    times.visit(v);
    v.child(hand), v.child(bottle);
    v.child(muscles), v.child(plans);
  }
};

Bank bank_of(const BankFile& file);
std::vector<PlanRow> rows_of(const Bank& bank);
/// A file's text with a bank's plans in place of its own.
std::string text_of(BankFile file, const Bank& bank);
/// Which actuators the learnt muscles are. Throws std::invalid_argument: one that there is not.
std::vector<std::size_t> actuators_of(const std::vector<LearntMuscle>& muscles,
                                      const erp::Robot& robot);
/// Throws std::invalid_argument: no plan, or one that has not a weight for each muscle.
void check(const BankFile& file);

}  // namespace sim::synergy
