#include <fmt/format.h>

#include <algorithm>

#include "launch/erp/gap/messages.hpp"
#include "launch/erp/gap/report_parts.hpp"
#include "launch/erp/gap/svg.hpp"

namespace launch::gap {

using namespace sim::diagnosis;
using svg::escaped;

namespace {

/// How far a channel was closed, in words where a share says nothing.
std::string closed_of(const Closed& c, bool with_interval) {
  if (!c.has_gap())
    return c.after > 1.5 * std::max(c.before, c.floor) ? "was no gap, is one now" : "–";
  if (c.after > c.before) return fmt::format("{:.1f} times as large", c.after / c.before);
  return fmt::format("{:.1f} %{}", 100 * std::min(1.0, c.closed),  // beyond is noise
                     with_interval ? closed_interval(c) : "");
}

std::string share_of(double error, double driven_by) {
  return driven_by > 0 ? fmt::format("{:.2f} %", 100 * error / driven_by) : "–";
}

}  // namespace

std::string page::stages(const Diagnosis& d) {
  std::string html =
      "<table><tr><th>stage</th><th>residual</th><th>floor</th><th>after</th><th>closed</th>"
      "<th>of what drives it, before</th><th>after</th></tr>\n";
  for (const Closed& c : d.channels)
    html += fmt::format(
        "<tr><td>{}</td><td>{:.3g} {}</td><td>{:.3g}</td><td>{:.3g}</td><td>{}</td>"
        "<td>{}</td><td>{}</td></tr>\n",
        escaped(c.channel), c.before, c.unit, c.floor, c.after, closed_of(c, true),
        share_of(c.before, c.driven_by), share_of(c.after, c.driven_by));
  return html + "</table>\n";
}

std::string page::free_running(const Diagnosis& d, const sim::closed_loop::FreeRun& run) {
  if (run.channels.empty()) return "";
  std::string html = fmt::format(
      "<h2>The simulator let run freely</h2>\n<p>On the references of {}, in closed "
      "loop with the firmware: {:.3g} times what noise alone would do before, {:.3g} after. "
      "That is: {}{}.</p>\n<table><tr><th>channel</th><th>before</th><th>noise "
      "alone</th>"
      "<th>after</th><th>closed</th></tr>\n",
      judged_on(d), run.all.before, run.all.after, closed_words(run.all), closed_interval(run.all));
  for (const Closed& c : run.channels)
    html += fmt::format(
        "<tr><td>{}</td><td>{:.3g} {}</td><td>{:.3g}</td><td>{:.3g}</td><td>{}</td></tr>\n",
        escaped(c.channel), c.before, c.unit, c.floor, c.after, closed_of(c, false));
  return html + "</table>\n";
}

}  // namespace launch::gap
