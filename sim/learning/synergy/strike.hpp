#pragma once
#include <cmath>
#include <vector>

#include "interfaces/xml/fields.hpp"
#include "sim/model/skeleton/pose.hpp"

/// What a trial is rewarded for: striking a bottle, and staying near it (paper, 5.5 and Fig. 10).
///
///   r = [struck] + zone_reward · (share of the time from the signal's end on that the hand was in the zone)
///
/// A bottle is an upright capsule, the hand a ball; touching is a matter of geometry, the bottle does
/// not move.
namespace sim::synergy {

/// `<bottle radius_m="0.0325" …/>`: sizes of what is struck, and by what; all chosen: half a litre, a palm.
struct BottleConfig {
  static constexpr auto element = "bottle";
  xml::Place place;
  double radius_m = 0.0325, height_m = 0.2;
  double hand_m = 0.04;  ///< radius of the hand
  double zone_m = 0.12;  ///< the hand's point is no farther from the bottle's middle: in the zone
  double zone_reward = 0.5;
  void visit(auto& v) {
    v("radius_m", radius_m, xml::positive);
    v("height_m", height_m, xml::positive);
    v("hand_m", hand_m, xml::at_least_zero);
    v("zone_m", zone_m, xml::positive);
    v("zone_reward", zone_reward, xml::at_least_zero);
  }
};

/// The hand's point from a plan's beginning on, equally far apart in time.
struct HandPath {
  double sample_s = 0.01;
  std::vector<Vec3> at_m;
};

struct Outcome {
  bool struck = false;
  double nearest_m = HUGE_VAL;  ///< between hand and bottle; below zero where they would overlap
  double strike_s = 0;          ///< when first; since the plan began
  double strike_speed_m_per_s = 0;  ///< of the hand, then
  double stayed = 0;                ///< share of the time after the signal's end, in the zone
  double reward = 0;
};
/// `end_s`: of the signal. A path without points is nothing struck.
Outcome judge(const BottleConfig& bottle, const Vec3& bottle_m, const HandPath& path, double end_s);

/// Where the hand is at last: the mean of its last 0.2 s.
Vec3 rest_of(const HandPath& path);

/// Σ |jerk|² until `end_s`, by differences over 50 ms, relative to that of the straight way from the
/// first to the last point with the least jerk, sampled alike: 1 at best.
double relative_jerk(const HandPath& path, double end_s);

}  // namespace sim::synergy
