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
  double side = 0;             // of the play, in widths
  std::size_t last_moved = 0;  // last row in which the sensor turned
  for (std::size_t k = 0; k < angle.size(); ++k) {
    if (!(std::abs(speed[k]) > still_rad_per_s)) continue;
    const double next = std::copysign(0.5, speed[k]);
    for (std::size_t between = last_moved + 1; between < k; ++between) {
      const double fraction = double(between - last_moved) / double(k - last_moved);
      angle[between] += width_rad * std::lerp(side, next, fraction);
    }
    angle[k] += width_rad * next;
    side = next, last_moved = k;
  }
  for (std::size_t k = last_moved + 1; k < angle.size(); ++k) angle[k] += width_rad * side;
  return angle;
}

std::vector<char> may_cross(const Signal& reading_rad, double period_s) {
  // Chosen: five times the noise of the speed for an angle noise of 0.5 mrad.
  constexpr double turning_rad_per_s = 0.1;
  constexpr double margin_s = 0.02;  // before and after a row; chosen
  const Signal speed = Bump(half_width_s, period_s).rates(reading_rad);
  const auto margin = static_cast<std::size_t>(std::lround(margin_s / period_s));
  std::vector<char> is_possible(reading_rad.size(), 1);
  std::size_t run = 0;  // number of successive rows that turn in one direction
  for (std::size_t k = 0; k < speed.size(); ++k) {
    const bool turns = std::abs(speed[k]) > turning_rad_per_s;
    const bool continues = turns && run > 0 && std::signbit(speed[k]) == std::signbit(speed[k - 1]);
    run = continues ? run + 1 : turns;
    if (run > 2 * margin) is_possible[k - margin] = 0;
  }
  return is_possible;
}

}  // namespace sim::residuals
