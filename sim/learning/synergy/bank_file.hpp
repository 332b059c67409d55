#pragma once
#include <string>

#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/plural.hpp"
#include "interfaces/xml/xml.hpp"
#include "sim/learning/synergy/bank.hpp"
#include "sim/learning/synergy/strike.hpp"
#include "sim/learning/synergy/trial.hpp"
#include "sim/model/skeleton/hand.hpp"

/// All data of a trial, as a file: `<synergy_bank>`.
namespace sim::synergy {

/// `<learned muscle="right_biceps"/>`: a muscle for which plans have a weight. The lines of
/// other muscles keep their length.
struct LearnedMuscle {
  static constexpr auto element = "learned", former_element = "learnt", plural = "muscles";
  static constexpr auto description = "Muscle that takes part.";
  xml::Place place;
  std::string muscle;
  void visit(auto& v) {
    v.required("muscle", muscle,
               "Muscle for which plans have a weight; the lines of the others keep their length.");
  }
};
struct PlanRow {
  static constexpr auto element = "plan", plural = "plans";
  static constexpr auto description = "Stored motor plan.";
  xml::Place place;
  xml::Vec3 at_m{};
  double value = 1, rise_s = 0.8, overshoot = 0;
  std::vector<double> weights_m;
  void visit(auto& v) {
    v.former("beyond", "overshoot");
    v.required("at_m", at_m, "Place that the hand reached with the plan, in the world.");
    v("value", value, {xml::at_least_zero, "Value v of the plan: running estimate of its reward."});
    v.required("rise_s", rise_s, {xml::positive, "Rise time T of the plan."});
    v("overshoot", overshoot, "Overshoot b of the plan, relative; negative: undershoot.");
    v.required("weights_m", weights_m, "Line length that each learned muscle winds up.");
  }
};
struct BankFile {
  static constexpr auto element = "synergy_bank";
  static constexpr auto description = "Motor plans, and all that a trial needs.";
  xml::Place place;
  int rounds = 0;
  std::string seed;
  xml::Vec3 rest_m{};
  BankOptions options;
  TrialTimes times;
  HandConfig hand;
  BottleConfig bottle;
  xml::Plural<LearnedMuscle> muscles;
  xml::Plural<PlanRow> plans;
  void visit(auto& v) {
    v("rounds", rounds, "Completed rounds of the training that wrote the file.");
    v("seed", seed, "Seed of that training.");
    v.required("rest_m", rest_m, "Position of the hand before a trial, in the world.");
    options.visit(v);
    times.visit(v);
    v.child(hand), v.child(bottle);
    v.child(muscles), v.child(plans);
  }
};

Bank bank_of(const BankFile& file);
std::vector<PlanRow> rows_of(const Bank& bank);
/// The text of `file` with the plans of `bank`.
std::string text_of(BankFile file, const Bank& bank);
/// Actuator indices of the learned muscles. Throws std::invalid_argument if one does not exist.
std::vector<std::size_t> actuators_of(const std::vector<LearnedMuscle>& muscles,
                                      const erp::Robot& robot);
/// Throws std::invalid_argument if there is no plan, or if a plan lacks a weight for each muscle.
void check(const BankFile& file);

}  // namespace sim::synergy
