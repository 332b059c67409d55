#include <fmt/format.h>

#include <algorithm>

#include "interfaces/xml/writer.hpp"
#include "launch/erp/gap/files.hpp"
#include "launch/erp/gap/messages.hpp"
#include "launch/erp/gap/report_parts.hpp"

namespace launch::gap {
namespace {

using namespace sim::diagnosis;
using xml::escaped;

constexpr const char* head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Differences between robot and model</title><style>
body{font:15px/1.45 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;color:#222}
h1{font-size:1.5rem;margin:0}h2{font-size:1.15rem;margin:2rem 0 .4rem;border-bottom:1px solid #ddd}
.verdict{font-size:1.2rem;padding:.6rem 1rem;border-left:6px solid #1e5aa0;background:#f3f6fa;margin:1rem 0}
.fault{padding:.6rem 1rem;border-left:6px solid #c0392b;background:#fbf0ee;margin:1rem 0}
table{border-collapse:collapse;margin:.5rem 0}td,th{padding:.2rem .7rem;text-align:right}
th{border-bottom:1px solid #999;font-weight:600}td:first-child,th:first-child{text-align:left}
svg{max-width:100%;height:auto;display:block;margin:.6rem 0}svg text{font-size:12px}
.t{font-weight:600;font-size:13px!important}.band{fill:#dfe9df}.grid{stroke:#e6e6e6}
.strong{fill:#1e5aa0}.weak{fill:#a9bfd8}.whisker{stroke:#222;stroke-width:1.5}
.note{color:#555}</style></head><body>
)";

std::string title_of(const Diagnosis& d) {
  switch (d.verdict) {
    case Verdict::no_gap:
      return fmt::format(
          "No gap{}: robot and model differ by no more than the noise of the sensors.",
          d.not_evaluated.empty() ? "" : " in the evaluated stages");
    case Verdict::supported:
      return fmt::format(
          "The gap is explained; the explanation is validated on {}{}.", validation_data(d),
          d.answer.empty() ? ". Cause: several constants together, each within its tolerance" : "");
    case Verdict::none_of_the_known:
      return "There is a gap, but none of the known effects explains all of it.";
    case Verdict::not_identifiable:
      if (!d.uses_held_out_data() && !d.answer.empty())
        return "There is a possible explanation, but no other recording to validate it: record "
               "another motion.";
  }
  return "These recordings do not identify the cause of the gap.";
}

std::string parameters_of(const IdentifiedEffect& n) {
  std::string text;
  for (std::size_t k = 0; k < n.names.size(); ++k)
    text += fmt::format("{}{} = {:.4g} ({:.4g} … {:.4g})", k ? ", " : "", n.names[k], n.values[k],
                        n.intervals[k].low, n.intervals[k].high);
  return text + fixed_parameters(n);
}

/// Faults of the recordings, which make all other results unreliable.
std::string fix_first(const Diagnosis& d) {
  if (d.fix_first.empty()) return "";
  std::string html =
      "<div class=\"fault\">Fix these recordings first and diagnose again. Until then no result "
      "below is reliable.\n<ul>\n";
  for (const std::string& fault : d.fix_first) html += "<li>" + escaped(fault) + "</li>\n";
  return html + "</ul></div>\n";
}

std::string summary(const Diagnosis& d) {
  std::string html = fix_first(d);
  html += fmt::format("<div class=\"verdict\">{}</div>\n", title_of(d));
  const bool is_explained = d.verdict == Verdict::supported;
  if (!d.answer.empty())
    html += is_explained ? "<ul>\n"
            : d.verdict == Verdict::not_identifiable
                ? "<p>Candidates:</p>\n<ul>\n"
                : "<p>These effects explain a part of the gap only:</p>\n<ul>\n";
  for (const IdentifiedEffect& n : d.answer)
    html += fmt::format("<li>{0}{2}{1}: {3}</li>\n", is_explained ? "<b>" : "",
                        is_explained ? "</b>" : "", escaped(page::name_of(n)),
                        escaped(parameters_of(n)));
  if (!d.answer.empty()) html += "</ul>\n";
  for (const IdentifiedEffect& n : d.answer) {
    if (n.alternatives.empty()) continue;
    html += fmt::format("<p>Equivalent to {}; these recordings do not distinguish them: ",
                        escaped(page::name_of(n)));
    for (std::size_t k = 0; k < n.alternatives.size(); ++k)
      html += fmt::format("{}{}", k ? ", " : "", escaped(page::name_of(n.alternatives[k])));
    html += ".</p>\n";
  }
  if (d.overall.before > 0)
    html +=
        fmt::format("<p>Residual on {}: {:.3g} times the noise before, {:.3g} after: {}{}.</p>\n",
                    validation_data(d), d.overall.before, d.overall.after, closure_text(d.overall),
                    closure_interval(d.overall));
  if (d.verdict == Verdict::supported)
    html +=
        "<p>In the same folder: robot.xml, the corrected model; diagnosis.json, all values.</p>\n";
  return html;
}

std::string purpose_of(const Diagnosis& d, const std::string& recording) {
  const bool trains = std::ranges::count(d.train, recording) > 0,
             validates = std::ranges::count(d.held_out, recording) > 0;
  return std::string(trains ? "training" : "") + (trains && validates ? ", " : "") +
         (validates ? "validation" : "");
}

std::string data(const Diagnosis& d) {
  std::string html = "<h2>Recordings</h2>\n<table><tr><th>file</th><th>used for</th></tr>\n";
  for (const std::string& name : d.recordings)
    html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escaped(name), purpose_of(d, name));
  html += "</table>\n";
  for (const std::string& warning : d.warnings)
    html += fmt::format("<p class=\"note\">{}</p>\n", escaped(warning));
  return html;
}

}  // namespace

std::string diagnosis_report(const Diagnosis& d, const sim::closed_loop::FreeRun& free_run,
                             const erp::Robot& robot) {
  return head +
         fmt::format("<h1>{}: differences between robot and model</h1>\n", escaped(robot.name)) +
         summary(d) + page::chains(d) + page::stages(d) + page::constants(d) + page::ranking(d) +
         page::worst_windows(d) + page::free_run(d, free_run) + page::unexplained(d) + data(d) +
         "</body></html>\n";
}

}  // namespace launch::gap
