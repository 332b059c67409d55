#pragma once
#include <string>
#include <vector>

#include "sim/learning/experience/patterns.hpp"
#include "sim/learning/experience/reach.hpp"
#include "sim/model/skeleton/hand.hpp"

/// Acquisition of experience, as a file: `<acquisition> <hand …/> <zone …/> <burst …/> … </…>`.
namespace sim::experience {

struct Task {
  static constexpr auto element = "acquisition";
  static constexpr auto description = "Training of erp learn experience.";
  xml::Place place;
  std::string starts;
  std::string rules;
  double rest_N = 30, least_N = 20;
  int rounds = 30, batch = 40;
  double noise_Vs = 0.5;
  double pattern_V = 10;
  double noise_m = 0.0002;
  double feedback_gain_per_s = 1.5;
  int seed = 1;
  ReachTimes times;
  HandConfig hand;
  ZoneConfig zone;
  xml::Plural<Burst> bursts;
  void visit(auto& v) {
    v.former("closing_per_s", "feedback_gain_per_s");
    v("starts", starts, "Postures (CSV) to start from; empty: where the robot starts.");
    v("rules", rules,
      "Rules of the fuzzy feedback in the FuzzyLite language, relative to the file; empty: none.");
    v("rest_N", rest_N, {xml::at_least_zero, "Mean tension in the starting posture; chosen."});
    v("least_N", least_N,
      {xml::at_least_zero,
       "Smallest tension in the starting posture, so that few tendons go slack; chosen."});
    v("rounds", rounds, {xml::Range{1, 1e5}, "Number of rounds of the training."});
    v("batch", batch, {xml::Range{2, 1e5}, "Number of trials in a round."});
    v("noise_Vs", noise_Vs,
      {xml::at_least_zero,
       "Standard deviation of the exploration of the scales, in every second trial; chosen."});
    v("pattern_V", pattern_V, {xml::positive, "Largest pattern voltage of a muscle; chosen."});
    v("noise_m", noise_m,
      {xml::at_least_zero, "Standard deviation of the measured hand position; chosen."});
    v("feedback_gain_per_s", feedback_gain_per_s,
      {xml::positive, "Gain b of linear feedback; chosen."});
    v("seed", seed, {xml::Range{0, 1e9}, "Seed of the training."});
    times.visit(v);
    v.child(hand), v.child(zone);
    v.child(bursts);
  }
};

}  // namespace sim::experience
