#pragma once
#include <vector>

#include "sim/gap/residuals/episode.hpp"

/// A joint whose sensor has play of width w: the joint angle q is within w/2 of the reading s.
///
///   the sensor turns in one direction    q = s ± w/2: the joint drives the sensor
///   the sensor rests or reverses         |q − s| ≤ w/2: the joint crosses the play, and q is not measured
///
/// Source: see sim/model/effects/joint/play.hpp. Ignores: motion within the play while the sensor
/// rests, unless it can be estimated from the tendons (joint_search.cpp).
namespace sim::residuals {

struct LooseJoint {
  std::size_t joint;
  double width_rad;  ///< w
  Signal reading_rad;
};

/// Returns q, with a linear transition where it crosses the play.
Signal without_play(const Signal& reading_rad, double width_rad, double period_s);

/// Returns for each row whether the sensor may rest or reverse; then the joint may cross the play.
std::vector<char> may_cross(const Signal& reading_rad, double period_s);

}  // namespace sim::residuals
