#pragma once
#include "sim/learning/synergy/bank_file.hpp"

/// A training task as a file: `<striking poses="reaches.csv"> <hand …/> <zone …/> … </striking>`.
namespace sim::synergy {

struct Task {
  static constexpr auto element = "striking";
  xml::Place place;
  std::string poses;  ///< poses.csv: one rough initial plan per row; relative to this file
  int rounds = 60, batch = 40;
  double noise = 0.05;     ///< relative standard deviation of the signal-dependent noise; chosen
  double margin_m = 0.08;  ///< plans that end at most this far outside the zone are stored; chosen
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
    v.required("poses", poses);
    v("rounds", rounds, xml::Range{1, 1e5});
    v("batch", batch, xml::Range{2, 1e5});
    v("noise", noise, xml::at_least_zero);
    v("margin_m", margin_m, xml::at_least_zero);
    v("seed", seed, xml::Range{0, 1e9});
    exploring.visit(v);
    options.visit(v);
    times.visit(v);
    v.child(hand), v.child(zone), v.child(bottle);
    v.child(muscles);
  }
};

}  // namespace sim::synergy
