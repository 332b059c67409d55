#include "sim/gap/diagnosis/sampling.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sim::diagnosis {

double reversal_share(const Evaluator& evaluator) {
  constexpr double resting_rad_per_s = 0.02;  // chosen: as in chain_trace.cpp
  double back = 0, all = 0;
  for (const residuals::Episode& e : evaluator.episodes())
    for (const residuals::ActuatorSignals& s : e.actuators)
      for (std::size_t k = 1; k + 1 < s.shaft_rad.size(); ++k) {
        const double least = resting_rad_per_s * e.period_s;
        const double before = s.shaft_rad[k] - s.shaft_rad[k - 1],
                     after = s.shaft_rad[k + 1] - s.shaft_rad[k];
        if (!(std::abs(before) > least && std::abs(after) > least)) continue;
        ++all, back += before * after < 0;
      }
  return all > 0 ? back / all : 0;
}

std::optional<std::string> rows_too_far_apart(const Evaluator& evaluator) {
  constexpr double most = 0.05;  // a third of the windows, of at least six rows each; chosen
  if (evaluator.nominal().drives.empty()) return std::nullopt;
  const double share = reversal_share(evaluator);
  if (share <= most) return std::nullopt;
  return fmt::format(
      "the shaft turned back at {:.0f} % of the rows with motion ({:.3g} ms apart), where friction "
      "acts in both directions: record more rows per second, or slower motions",
      100 * share, 1e3 * evaluator.episodes()[0].period_s);
}

}  // namespace sim::diagnosis
