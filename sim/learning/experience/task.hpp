#pragma once
#include <string>
#include <vector>

#include "sim/learning/experience/patterns.hpp"
#include "sim/learning/experience/reach.hpp"
#include "sim/model/skeleton/hand.hpp"

/// How experience is acquired, as a file: `<acquisition> <hand …/> <zone …/> <burst …/> … </…>`.
namespace sim::experience {

struct Task {
  static constexpr auto element = "acquisition";
  xml::Place place;
  std::string starts;  ///< poses.csv of postures to start from; "": where the robot starts
  std::string rules;   ///< file of the fuzzy feedback, in the FuzzyLite language
  /// Tensions in the starting posture, so that few tendons go slack; chosen.
  double rest_N = 30, least_N = 20;
  int rounds = 30, batch = 40;
  double noise_Vs = 0.5;    ///< exploration noise of the scales, in every second trial; chosen
  double pattern_V = 10;    ///< largest pattern voltage of a muscle; chosen
  double noise_m = 0.0002;  ///< measurement noise of the hand position; chosen
  double feedback_gain_per_s = 1.5;  ///< gain b of linear feedback; chosen
  int seed = 1;
  ReachTimes times;
  HandConfig hand;
  ZoneConfig zone;
  xml::Plural<Burst> bursts;
  void visit(auto& v) {
    v.former("closing_per_s", "feedback_gain_per_s");
    v("starts", starts);
    v("rules", rules);
    v("rest_N", rest_N, xml::at_least_zero);
    v("least_N", least_N, xml::at_least_zero);
    v("rounds", rounds, xml::Range{1, 1e5});
    v("batch", batch, xml::Range{2, 1e5});
    v("noise_Vs", noise_Vs, xml::at_least_zero);
    v("pattern_V", pattern_V, xml::positive);
    v("noise_m", noise_m, xml::at_least_zero);
    v("feedback_gain_per_s", feedback_gain_per_s, xml::positive);
    v("seed", seed, xml::Range{0, 1e9});
    times.visit(v);
    v.child(hand), v.child(zone);
    v.child(bursts);
  }
};

}  // namespace sim::experience
