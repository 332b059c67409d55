#include "sim/gap/residuals/loose_joint.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gap/residuals/bump.hpp"

namespace sim::residuals {
namespace {

constexpr double half_width_s = 0.016;  // of the window of a speed; chosen

}  // namespace

Signal taken_up(const Signal& said_rad, double loose_rad, double period_s) {
  constexpr double still_rad_per_s = 0.03;  // chosen
  const Signal speed = Bump(half_width_s, period_s).rates(said_rad);
  Signal angle = said_rad;
  double side = 0;
  std::size_t moved = 0;  // the row after which it rests
  for (std::size_t k = 0; k < angle.size(); ++k) {
    if (!(std::abs(speed[k]) > still_rad_per_s)) continue;
    const double now = std::copysign(0.5, speed[k]);
    for (std::size_t between = moved + 1; between < k; ++between) {
      const double share = double(between - moved) / double(k - moved);
      angle[between] += loose_rad * std::lerp(side, now, share);
    }
    angle[k] += loose_rad * now;
    side = now, moved = k;
  }
  for (std::size_t k = moved + 1; k < angle.size(); ++k) angle[k] += loose_rad * side;
  return angle;
}

std::vector<char> may_cross(const Signal& said_rad, double period_s) {
  // Five times what noise of 0.5 mrad makes of a speed, for as long as a window either side; chosen.
  constexpr double surely_rad_per_s = 0.1, around_s = 0.02;
  const Signal speed = Bump(half_width_s, period_s).rates(said_rad);
  const auto around = static_cast<std::size_t>(std::lround(around_s / period_s));
  std::vector<char> may(said_rad.size(), 1);
  std::size_t run = 0;  // rows that surely turn one way, up to this one
  for (std::size_t k = 0; k < speed.size(); ++k) {
    const bool turns = std::abs(speed[k]) > surely_rad_per_s;
    const bool on = turns && run > 0 && std::signbit(speed[k]) == std::signbit(speed[k - 1]);
    run = on ? run + 1 : turns;
    if (run > 2 * around) may[k - around] = 0;
  }
  return may;
}

}  // namespace sim::residuals
