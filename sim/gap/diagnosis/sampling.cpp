#include "sim/gap/diagnosis/sampling.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sim::diagnosis {

double reversal_fraction(const Evaluator& evaluator) {
  constexpr double resting_rad_per_s = 0.02;  // chosen: as in chain_trace.cpp
  double reversals = 0, moving = 0;
  for (const residuals::Episode& e : evaluator.episodes())
    for (const residuals::ActuatorSignals& s : e.actuators)
      for (std::size_t k = 1; k + 1 < s.shaft_rad.size(); ++k) {
        const double least_travel_rad = resting_rad_per_s * e.period_s;
        const double before = s.shaft_rad[k] - s.shaft_rad[k - 1],
                     after = s.shaft_rad[k + 1] - s.shaft_rad[k];
        if (!(std::abs(before) > least_travel_rad && std::abs(after) > least_travel_rad)) continue;
        ++moving, reversals += before * after < 0;
      }
  return moving > 0 ? reversals / moving : 0;
}

std::optional<std::string> rows_too_far_apart(const Evaluator& evaluator) {
  // A third of the windows, of at least six rows each; chosen.
  constexpr double max_fraction = 0.05;
  if (evaluator.nominal().drives.empty()) return std::nullopt;
  const double fraction = reversal_fraction(evaluator);
  if (fraction <= max_fraction) return std::nullopt;
  return fmt::format(
      "the shaft turned back at {:.0f} % of the rows with motion ({:.3g} ms apart), where friction "
      "acts in both directions: record more rows per second, or slower motions",
      100 * fraction, 1e3 * evaluator.episodes()[0].period_s);
}

}  // namespace sim::diagnosis
