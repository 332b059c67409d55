#pragma once
#include <string>

#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/plural.hpp"
#include "interfaces/xml/xml.hpp"
#include "sim/learning/synergy/bank.hpp"
#include "sim/learning/synergy/strike.hpp"
#include "sim/learning/synergy/trial.hpp"
#include "sim/model/skeleton/hand.hpp"

/// Everything that a trial needs, as a file: `<synergy_bank>`.
namespace sim::synergy {

/// `<learned muscle="right_biceps"/>`: a muscle that plans have a weight for. The lines of the
/// others keep their length.
struct LearnedMuscle {
  static constexpr auto element = "learned", former_element = "learnt", plural = "muscles";
  xml::Place place;
  std::string muscle;
  void visit(auto& v) { v.required("muscle", muscle); }
};
struct PlanRow {
  static constexpr auto element = "plan", plural = "plans";
  xml::Place place;
  xml::Vec3 at_m{};
  double value = 1, rise_s = 0.8, overshoot = 0;
  std::vector<double> weights_m;
  void visit(auto& v) {
    v.required("at_m", at_m);
    v("value", value, xml::at_least_zero);
    v.required("rise_s", rise_s, xml::positive);
    v.former("beyond", "overshoot");
    v("overshoot", overshoot);
    v.required("weights_m", weights_m);
  }
};
struct BankFile {
  static constexpr auto element = "synergy_bank";
  xml::Place place;
  int rounds = 0;  ///< completed rounds of the training that wrote it
  std::string seed;
  xml::Vec3 rest_m{};  ///< position of the hand before a trial, in the world
  BankOptions options;
  TrialTimes times;
  HandConfig hand;
  BottleConfig bottle;
  xml::Plural<LearnedMuscle> muscles;
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
/// The text of `file` with the plans of `bank`.
std::string text_of(BankFile file, const Bank& bank);
/// Actuator indices of the learned muscles. Throws std::invalid_argument if one does not exist.
std::vector<std::size_t> actuators_of(const std::vector<LearnedMuscle>& muscles,
                                      const erp::Robot& robot);
/// Throws std::invalid_argument if there is no plan, or if a plan lacks a weight for each muscle.
void check(const BankFile& file);

}  // namespace sim::synergy
