#include "launch/gap/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace launch::gap {

std::string closed_words(const sim::diagnosis::Closed& c) {
  if (c.before <= c.floor) return "there was nothing to close";
  if (c.after > c.before) return fmt::format("{:.1f} times as large", c.after / c.before);
  return fmt::format("{:.1f} % closed", 100 * std::min(1.0, c.closed));
}

std::string closed_interval(const sim::diagnosis::Closed& c) {
  if (c.before <= c.floor || c.after > c.before) return "";
  return fmt::format(" ({:.1f} … {:.1f} %)", 100 * std::min(1.0, c.interval.low),
                     100 * std::min(1.0, c.interval.high));
}

std::string judged_on(const sim::diagnosis::Diagnosis& d) {
  if (!d.judged_apart()) return "the data it was found on";
  const bool only_rests = std::ranges::all_of(d.held_out, [&](const std::string& name) {
    return std::ranges::count(d.shared, name, &sim::diagnosis::Shared::recording) > 0;
  });
  return only_rests ? "the rest of the recording" : "held-out recordings";
}

std::string share_words(double share) {
  return share < 0.005 ? "under 1 %" : fmt::format("{:.0f} %", 100 * share);
}

std::string zero_doubt(const std::vector<sim::diagnosis::Named>& answer, const erp::Robot& robot) {
  auto offset = *sim::effects::neutral("sensor_shaft_offset");
  const double widest_rad = sim::effects::parameters(offset)[0].bounds.high;
  for (const auto& n : answer) {
    if (n.type != "tendon_length_offset") continue;
    const auto actuator = std::ranges::find(robot.actuators, n.on, &erp::Actuator::name);
    const double zero_rad = -n.values[0] / actuator->spindle.radius_m;
    if (std::abs(zero_rad) > widest_rad)
      return fmt::format(
          "{}.shaft_rad: a zero that is {:.3g} rad off would look the same as this "
          "tendon_length_offset: "
          "if the encoder was not zeroed at the robot's initial pose, add {:.4g} to the column",
          n.on, zero_rad, -zero_rad);
  }
  return "";
}

std::string free_run_doubt(const sim::diagnosis::Closed& c) {
  constexpr double plain = 2, enough = 0.5;  // chosen: of the noise, and closed
  constexpr double rest = 3;                 // chosen: of the noise
  if (c.closed >= enough && c.after > rest * c.floor)
    return fmt::format(
        "let run freely with them, the simulator stays {:.3g} times what noise alone would do off: "
        "something small is left that these residuals show too little of; record other motions",
        c.after);
  if (c.before <= plain * c.floor || c.closed >= enough) return "";
  return fmt::format(
      "let run freely, the simulator is {:.3g} times what noise alone would do off, and {:.3g} "
      "with "
      "the effects: they may only look like the cause; record other motions",
      c.before, c.after);
}

}  // namespace launch::gap
