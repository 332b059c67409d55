#pragma once
#include <cmath>
#include <vector>

#include "interfaces/xml/fields.hpp"
#include "sim/model/skeleton/pose.hpp"

/// The reward of a trial: for striking a bottle, and for staying near it (paper, 5.5 and Fig. 10).
///
///   r = [struck] + zone_reward · (fraction of the time after the signal with the hand in the zone)
///
/// A bottle is an upright capsule, the hand a sphere. A strike is a geometric overlap; the bottle
/// does not move.
namespace sim::synergy {

/// `<bottle radius_m="0.0325" …/>`: sizes of the bottle and of the hand.
struct BottleConfig {
  static constexpr auto element = "bottle";
  static constexpr auto description = "Sizes of bottle and hand, and the reward.";
  xml::Place place;
  double radius_m = 0.0325, height_m = 0.2;
  double hand_m = 0.04;
  double zone_m = 0.12;
  double zone_reward = 0.5;
  void visit(auto& v) {
    v("radius_m", radius_m, {xml::positive, "Radius of the bottle; half a litre; chosen."});
    v("height_m", height_m, {xml::positive, "Height of the bottle; chosen."});
    v("hand_m", hand_m, {xml::at_least_zero, "Radius of the hand, a sphere; a palm; chosen."});
    v("zone_m", zone_m,
      {xml::positive,
       "Radius of the zone: distance of the hand's point from the centre of the bottle; chosen."});
    v("zone_reward", zone_reward,
      {xml::at_least_zero,
       "Reward for a hand that remains in the zone after the plan; a strike gives 1; chosen."});
  }
};

/// Positions of the hand's point from the beginning of a plan, at a constant sampling period.
struct HandPath {
  double sample_s = 0.01;
  std::vector<Vec3> at_m;
};

struct Outcome {
  bool struck = false;
  /// Smallest distance of the surfaces of hand and bottle; negative: overlap.
  double nearest_m = HUGE_VAL;
  double strike_s = 0;              ///< time of the first strike, since the plan began
  double strike_speed_m_per_s = 0;  ///< speed of the hand at the strike
  double stayed = 0;  ///< fraction of the time after the signal's end with the hand in the zone
  double reward = 0;
};
/// `end_s` is the signal's end. An empty path strikes nothing.
Outcome evaluate(const BottleConfig& bottle, const Vec3& bottle_m, const HandPath& path,
                 double end_s);

/// Final position of the hand: the mean of its last 0.2 s.
Vec3 rest_of(const HandPath& path);

/// Σ |jerk|² until `end_s`, by differences over 50 ms, relative to that of the straight
/// minimum-jerk path from the first to the last point with the same sampling. The minimum is 1.
double relative_jerk(const HandPath& path, double end_s);

}  // namespace sim::synergy
