#include "sim/gap/residuals/loose_joint.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gap/residuals/bump.hpp"

namespace sim::residuals {
namespace {

constexpr double half_width_s = 0.016;  // of the window of a speed; chosen

}  // namespace

Signal without_play(const Signal& reading_rad, double width_rad, double period_s) {
  constexpr double still_rad_per_s = 0.03;  // chosen
  const Signal speed = Bump(half_width_s, period_s).rates(reading_rad);
  Signal angle = reading_rad;
  double side = 0;
  std::size_t moved = 0;  // last row in which it turned
  for (std::size_t k = 0; k < angle.size(); ++k) {
    if (!(std::abs(speed[k]) > still_rad_per_s)) continue;
    const double next = std::copysign(0.5, speed[k]);
    for (std::size_t between = moved + 1; between < k; ++between) {
      const double share = double(between - moved) / double(k - moved);
      angle[between] += width_rad * std::lerp(side, next, share);
    }
    angle[k] += width_rad * next;
    side = next, moved = k;
  }
  for (std::size_t k = moved + 1; k < angle.size(); ++k) angle[k] += width_rad * side;
  return angle;
}

std::vector<char> may_cross(const Signal& reading_rad, double period_s) {
  // Five times the noise of the speed for an angle noise of 0.5 mrad, on both sides over a window; chosen.
  constexpr double turning_rad_per_s = 0.1, around_s = 0.02;
  const Signal speed = Bump(half_width_s, period_s).rates(reading_rad);
  const auto around = static_cast<std::size_t>(std::lround(around_s / period_s));
  std::vector<char> may(reading_rad.size(), 1);
  std::size_t run = 0;  // rows up to this one that turn in one direction
  for (std::size_t k = 0; k < speed.size(); ++k) {
    const bool turns = std::abs(speed[k]) > turning_rad_per_s;
    const bool on = turns && run > 0 && std::signbit(speed[k]) == std::signbit(speed[k - 1]);
    run = on ? run + 1 : turns;
    if (run > 2 * around) may[k - around] = 0;
  }
  return may;
}

}  // namespace sim::residuals
