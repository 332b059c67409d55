#pragma once
#include <vector>

#include "sim/gap/residuals/episode.hpp"

/// A joint's sensor whose shaft is loose: the bone is within half the looseness w of where it says.
///
///   the sensor turns one way   q = said ± w/2: the bone takes it along
///   it rests, or turns back    |q − said| ≤ w/2: the bone crosses unseen
///
/// Source: the effect's, sim/model/effects/joint/play.hpp. Ignores: bones that swing within w while the sensor rests, unless tendons tell of it
/// (joint_search.cpp).
namespace sim::residuals {

struct LooseJoint {
  std::size_t joint;
  double width_rad;  ///< w
  Signal said_rad;
};

/// q, evenly across where it crosses.
Signal taken_up(const Signal& said_rad, double loose_rad, double period_s);

/// Rows at which the sensor may be at rest, or turn back.
std::vector<char> may_cross(const Signal& said_rad, double period_s);

}  // namespace sim::residuals
