#pragma once
#include <vector>

#include "sim/gap/residuals/episode.hpp"

/// A joint's sensor with play of width w: the body's angle q is within w/2 of the sensor's reading s.
///
///   the sensor turns in one direction   q = s ± w/2: the body drives the sensor
///   it rests or reverses                |q − s| ≤ w/2: the body crosses the play, not measured
///
/// Source: that of the effect, sim/model/effects/joint/play.hpp. Ignores: bodies that swing within w while the sensor
/// rests, unless the tendons show it (joint_search.cpp).
namespace sim::residuals {

struct LooseJoint {
  std::size_t joint;
  double width_rad;  ///< w
  Signal reading_rad;
};

/// q, with a linear transition where it crosses the play.
Signal without_play(const Signal& reading_rad, double width_rad, double period_s);

/// Rows at which the sensor may rest or reverse, so that the body may cross the play.
std::vector<char> may_cross(const Signal& reading_rad, double period_s);

}  // namespace sim::residuals
