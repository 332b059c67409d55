#include <fmt/format.h>

#include <algorithm>

#include "interfaces/xml/writer.hpp"
#include "launch/erp/gap/messages.hpp"
#include "launch/erp/gap/report_parts.hpp"

namespace launch::gap {

using namespace sim::diagnosis;
using xml::escaped;

namespace {

/// Gap closure of a channel in percent; without a gap, a text.
std::string closed_of(const ClosedGap& c, bool with_interval) {
  constexpr double new_gap_factor = 1.5;  // chosen
  if (!c.has_gap())
    return c.after > new_gap_factor * std::max(c.before, c.floor) ? "no gap before, gap after"
                                                                  : "–";
  if (c.after > c.before) return fmt::format("{:.1f} times as large", c.after / c.before);
  return fmt::format("{:.1f} %{}", 100 * std::min(1.0, c.closed),  // the excess is noise
                     with_interval ? closure_interval(c) : "");
}

std::string relative(double error, double driven_by) {
  return driven_by > 0 ? fmt::format("{:.2f} %", 100 * error / driven_by) : "–";
}

}  // namespace

std::string page::stages(const Diagnosis& d) {
  std::string html =
      "<table><tr><th>stage</th><th>residual before</th><th>noise</th><th>residual after</th>"
      "<th>closed</th><th>share of the stage's input, before</th><th>after</th></tr>\n";
  for (const ClosedGap& c : d.channels)
    html += fmt::format(
        "<tr><td>{}</td><td>{:.3g} {}</td><td>{:.3g}</td><td>{:.3g}</td><td>{}</td>"
        "<td>{}</td><td>{}</td></tr>\n",
        escaped(c.channel), c.before, c.unit, c.floor, c.after, closed_of(c, true),
        relative(c.before, c.driven_by), relative(c.after, c.driven_by));
  return html + "</table>\n";
}

std::string page::free_run(const Diagnosis& d, const sim::closed_loop::FreeRun& run) {
  if (run.channels.empty()) return "";
  std::string html = fmt::format(
      "<h2>Free-run simulation</h2>\n<p>The simulator runs the references of {} in closed loop "
      "with the firmware. Error: {:.3g} times the noise before, {:.3g} after: {}{}.</p>\n"
      "<table><tr><th>channel</th><th>error before</th><th>noise</th><th>error after</th>"
      "<th>closed</th></tr>\n",
      validation_data(d), run.all.before, run.all.after, closure_text(run.all),
      closure_interval(run.all));
  for (const ClosedGap& c : run.channels)
    html += fmt::format(
        "<tr><td>{}</td><td>{:.3g} {}</td><td>{:.3g}</td><td>{:.3g}</td><td>{}</td></tr>\n",
        escaped(c.channel), c.before, c.unit, c.floor, c.after, closed_of(c, false));
  return html + "</table>\n";
}

}  // namespace launch::gap
