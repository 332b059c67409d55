#include "launch/gap/words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace launch::gap {

std::string closed_words(const sim::diagnosis::Closed& c) {
  if (c.before <= c.floor) return "there was nothing to close";
  if (c.after > c.before) return fmt::format("{:.1f} times as large", c.after / c.before);
  return fmt::format("{:.1f} % closed", 100 * std::min(1.0, c.closed));
}

std::string closed_interval(const sim::diagnosis::Closed& c) {
  return fmt::format("{:.1f} … {:.1f} %", 100 * std::min(1.0, c.interval.low),
                     100 * std::min(1.0, c.interval.high));
}

std::string judged_on(const sim::diagnosis::Diagnosis& d) {
  return d.train == d.held_out ? "the data it was found on" : "held-out recordings";
}

std::string free_run_doubt(const sim::diagnosis::Closed& c) {
  constexpr double plain = 2, enough = 0.5;  // chosen: of the noise, and closed
  if (c.before <= plain * c.floor || c.closed >= enough) return "";
  return fmt::format(
      "let run freely, the simulator is {:.3g} times what noise alone would do off, and {:.3g} "
      "with "
      "the effects: they may only look like the cause; record other motions",
      c.before, c.after);
}

}  // namespace launch::gap
