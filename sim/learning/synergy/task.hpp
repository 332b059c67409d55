#pragma once
#include "sim/learning/synergy/bank_file.hpp"

/// What is to be learnt, as a file: `<striking poses="reaches.csv"> <hand …/> <zone …/> … </striking>`.
namespace sim::synergy {

struct Task {
  static constexpr auto element = "striking";
  xml::Place place;
  std::string poses;  ///< poses.csv: a rough starting plan a row, beside this file
  int rounds = 60, batch = 40;
  double noise = 0.05;     ///< deviation of the signal-dependent noise, a share; chosen
  double beyond_m = 0.08;  ///< plans that lead no farther out of the zone are kept; chosen
  int seed = 1;
  Exploring exploring;
  BankOptions options;
  TrialTimes times;
  HandConfig hand;
  ZoneConfig zone;
  BottleConfig bottle;
  xml::Plural<LearntMuscle> muscles;
  void visit(auto& v) {
    v.required("poses", poses);
    v("rounds", rounds, xml::Range{1, 1e5});
    v("batch", batch, xml::Range{2, 1e5});
    v("noise", noise, xml::at_least_zero);
    v("beyond_m", beyond_m, xml::at_least_zero);
    v("seed", seed, xml::Range{0, 1e9});
    exploring.visit(v);
    options.visit(v);
    times.visit(v);
    v.child(hand), v.child(zone), v.child(bottle);
    v.child(muscles);
  }
};

}  // namespace sim::synergy
