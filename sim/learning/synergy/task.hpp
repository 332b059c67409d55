#pragma once
#include "sim/learning/synergy/bank_file.hpp"

/// A training task as a file: `<striking poses="reaches.csv"> <hand …/> <zone …/> … </striking>`.
namespace sim::synergy {

struct Task {
  static constexpr auto element = "striking";
  static constexpr auto description = "Training of erp learn synergy.";
  xml::Place place;
  std::string poses;
  int rounds = 60, batch = 40;
  double noise = 0.05;
  double margin_m = 0.08;
  int seed = 1;
  Exploration exploring;
  BankOptions options;
  TrialTimes times;
  HandConfig hand;
  ZoneConfig zone;
  BottleConfig bottle;
  xml::Plural<LearnedMuscle> muscles;
  void visit(auto& v) {
    v.former("beyond_m", "margin_m");
    v.required("poses", poses,
               "Poses (CSV), one rough initial plan per row, relative to the file.");
    v("rounds", rounds, {xml::Range{1, 1e5}, "Number of rounds of the training."});
    v("batch", batch, {xml::Range{2, 1e5}, "Number of trials in a round."});
    v("noise", noise,
      {xml::at_least_zero, "Relative standard deviation of the signal-dependent noise; chosen."});
    v("margin_m", margin_m,
      {xml::at_least_zero,
       "Largest distance from the zone at which plans may end to be stored; chosen."});
    v("seed", seed, {xml::Range{0, 1e9}, "Seed of the training."});
    exploring.visit(v);
    options.visit(v);
    times.visit(v);
    v.child(hand), v.child(zone), v.child(bottle);
    v.child(muscles);
  }
};

}  // namespace sim::synergy
