#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "launch/erp/gap_files.hpp"
#include "launch/erp/svg.hpp"

namespace launch {
namespace {

using namespace sim::diagnosis;
using sim::effects::Stage;
using svg::escaped;

constexpr const char* head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Where robot and model part</title><style>
body{font:15px/1.45 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;color:#222}
h1{font-size:1.5rem;margin:0}h2{font-size:1.15rem;margin:2rem 0 .4rem;border-bottom:1px solid #ddd}
.verdict{font-size:1.2rem;padding:.6rem 1rem;border-left:6px solid #1e5aa0;background:#f3f6fa;margin:1rem 0}
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
          d.not_judged.empty() ? "" : " in what could be judged");
    case Verdict::supported:
      return "An explanation that recordings held out support.";
    case Verdict::none_of_the_known:
      return "There is a gap, and none of the known effects explains it.";
    case Verdict::not_identifiable:
      break;
  }
  return "These recordings cannot show what the gap is.";
}

std::string name_of(const Named& n) { return n.type + " on " + n.on; }

std::string parameters_of(const Named& n) {
  std::string text;
  for (std::size_t k = 0; k < n.names.size(); ++k)
    text += fmt::format("{}{} = {:.4g} ({:.4g} … {:.4g})", k ? ", " : "", n.names[k], n.values[k],
                        n.intervals[k].low, n.intervals[k].high);
  return text;
}

std::string summary(const Diagnosis& d) {
  std::string html = fmt::format("<div class=\"verdict\">{}</div>\n", title_of(d));
  if (!d.answer.empty()) html += "<ul>\n";
  for (const Named& n : d.answer)
    html += fmt::format("<li><b>{}</b>: {}</li>\n", escaped(name_of(n)), escaped(parameters_of(n)));
  if (!d.answer.empty()) html += "</ul>\n";
  for (const Named& n : d.answer) {
    if (n.alike.empty()) continue;
    html += fmt::format("<p>As good as {}, and not to be told apart by these recordings: ",
                        escaped(name_of(n)));
    for (std::size_t k = 0; k < n.alike.size(); ++k)
      html += fmt::format("{}{}", k ? ", " : "", escaped(name_of(n.alike[k])));
    html += ".</p>\n";
  }
  if (d.overall.before > 0)
    html += fmt::format(
        "<p>Error on held-out recordings, in units of noise: {:.3g} before, {:.3g} "
        "after. Closed: {:.1f} % ({:.1f} … {:.1f}).</p>\n",
        d.overall.before, d.overall.after, 100 * d.overall.closed, 100 * d.overall.interval.low,
        100 * d.overall.interval.high);
  if (d.verdict == Verdict::supported)
    html += "<p>Beside this page: robot.xml, the model with it; diagnosis.json, all figures.</p>\n";
  return html;
}

/// The places that share the largest part, for the sensors cannot tell them apart.
std::string alike(const Diagnosis& d) {
  std::string names;
  std::size_t count = 0;
  for (const Located& place : d.where)
    if (place.share == d.where[0].share)
      names += fmt::format("{}{} of {}", count++ ? ", " : "", sim::effects::word(place.stage),
                           escaped(place.on));
  if (count < 2) return "";
  return "<p>It is in one of these, which recordings of these sensors do not tell apart: " + names +
         ".</p>\n";
}

/// When the residual lives; once for places that are told apart by nothing.
std::string when(const Diagnosis& d) {
  std::string html;
  for (const Located& place : d.where) {
    if (place.when.empty()) continue;
    const auto told = fmt::format("{:.0f} % of the residual lives in the {} fifth of the {}.</p>\n",
                                  100 * place.when[0].share, place.when[0].fifth,
                                  escaped(place.when[0].variable));
    if (html.find(told) == std::string::npos)
      html +=
          fmt::format("<p>{} of {}: {}", sim::effects::word(place.stage), escaped(place.on), told);
  }
  return html;
}

/// The chain of each actuator or joint that has a part of the gap.
std::string chains(const Diagnosis& d) {
  const std::vector<std::string> names{"bus",     "motor", "gearbox",  "spindle", "tendon",
                                       "routing", "joint", "skeleton", "sensor"};
  std::vector<std::string> places;
  for (const Located& place : d.where)
    if (!std::ranges::count(places, place.on)) places.push_back(place.on);
  std::string html = "<h2>Where</h2>\n";
  if (places.empty())
    html += svg::chain(d.not_judged.empty() ? "every stage is at its floor"
                                            : "every stage that could be judged is at its floor",
                       names, std::vector<double>(9, 0.0));
  if (!d.not_judged.empty())
    html += fmt::format("<p class=\"note\">Not judged: {}.</p>\n",
                        escaped(fmt::format("{}", fmt::join(d.not_judged, ", "))));
  for (const std::string& on : places) {
    std::vector<double> shares(names.size(), 0.0);
    for (const Located& place : d.where)
      if (place.on == on) shares[static_cast<std::size_t>(place.stage)] += place.share;
    html += svg::chain(on, names, shares);
  }
  return html + alike(d) + when(d);
}

std::string stages(const Diagnosis& d) {
  std::string html =
      "<table><tr><th>stage</th><th>residual</th><th>floor</th><th>after</th><th>closed</th>"
      "<th>of what drives it, before</th><th>after</th></tr>\n";
  for (const Closed& c : d.channels)
    html += fmt::format(
        "<tr><td>{}</td><td>{:.3g} {}</td><td>{:.3g}</td><td>{:.3g}</td><td>{}</td>"
        "<td>{:.2f} %</td><td>{:.2f} %</td></tr>\n",
        escaped(c.channel), c.before, c.unit, c.floor, c.after,
        c.before > 1.5 * c.floor ? fmt::format("{:.1f} % ({:.1f} … {:.1f})", 100 * c.closed,
                                               100 * c.interval.low, 100 * c.interval.high)
                                 : "–",
        100 * c.before / c.driven_by, 100 * c.after / c.driven_by);
  return html + "</table>\n";
}

std::string moments(const Diagnosis& d) {
  if (d.worst.empty()) return "";
  std::string html =
      "<h2>The worst moments</h2>\n<p class=\"note\">The green band is twice the noise; where a "
      "line breaks, a window cannot be judged, as when a shaft rests.</p>\n";
  for (const Moment& m : d.worst)
    html += svg::plot(
        {fmt::format("{} of {}, {}", sim::effects::word(m.stage), m.on, m.recording), "time, s",
         m.unit, 860, 230, 2 * m.floor},
        {{"before", "#c0392b", m.time_s, m.before}, {"after", "#1e5aa0", m.time_s, m.after}});
  return html;
}

std::string ranking(const Diagnosis& d) {
  if (d.ranked.empty()) return "";
  constexpr std::size_t most = 14;
  std::vector<svg::Bar> bars;
  std::vector<std::string> rows, columns;
  std::vector<std::vector<double>> cells;
  for (const StageGap& gap : d.stages)
    columns.push_back(fmt::format("{} {}", sim::effects::word(gap.stage), gap.on));
  for (std::size_t k = 0; k < d.ranked.size() && k < most; ++k) {
    const Named& n = d.ranked[k];
    bars.push_back({name_of(n), fmt::format("{:.1f} %", 100 * n.gain), n.gain, n.gain_interval.low,
                    n.gain_interval.high, n.supported});
    if (n.signature.empty() || columns.size() > 24) continue;
    rows.push_back(name_of(n)), cells.push_back(n.signature);
    cells.back().push_back(std::abs(n.likeness));
  }
  columns.push_back("like the first");
  std::string html =
      "<h2>Which</h2>\n<p class=\"note\">First those that take away 30 % of what some stage shows; "
      "of equals, the plainer.</p>\n" +
      svg::bars("Share of the gap that each effect alone takes away, held out", bars, 1);
  if (!rows.empty())
    html +=
        svg::matrix("Signatures: at which stage an effect shows, in percent", rows, columns, cells);
  return html;
}

std::string free_running(const sim::rehearsal::FreeRun& run) {
  if (run.channels.empty()) return "";
  std::string html = fmt::format(
      "<h2>The simulator let run freely</h2>\n<p>On the held-out recordings' references, in closed "
      "loop with the firmware: {:.3g} times what noise alone would do before, {:.3g} after. "
      "Closed: "
      "{:.1f} % ({:.1f} … {:.1f}).</p>\n<table><tr><th>channel</th><th>before</th><th>noise "
      "alone</th>"
      "<th>after</th><th>closed</th></tr>\n",
      run.all.before, run.all.after, 100 * run.all.closed, 100 * run.all.interval.low,
      100 * run.all.interval.high);
  for (const Closed& c : run.channels)
    html += fmt::format(
        "<tr><td>{}</td><td>{:.3g} {}</td><td>{:.3g}</td><td>{:.3g}</td><td>{}</td></tr>\n",
        escaped(c.channel), c.before, c.unit, c.floor, c.after,
        c.before > 1.5 * c.floor ? fmt::format("{:.1f} %", 100 * c.closed) : "–");
  return html + "</table>\n";
}

std::string rest(const Diagnosis& d) {
  if (d.unexplained.empty()) return "";
  std::string html = "<h2>What no effect explains</h2>\n";
  for (const Unexplained& u : d.unexplained) {
    html += fmt::format("<p>{} of {}: {:.3g} times its noise.", sim::effects::word(u.stage),
                        escaped(u.on), std::sqrt(1 + u.excess));
    if (!u.shape) {
      html += "</p>\n";
      continue;
    }
    html += fmt::format(" A map over the {} foretells {:.0f} % of it.</p>\n",
                        escaped(u.shape->variable), 100 * std::max(0.0, u.shape->explained));
    std::vector<double> low = u.shape->mean, high = u.shape->mean;
    for (std::size_t k = 0; k < low.size(); ++k)
      low[k] -= u.shape->deviation[k], high[k] += u.shape->deviation[k];
    html += svg::plot({fmt::format("{} of {}", sim::effects::word(u.stage), u.on),
                       fmt::format("{}, {}", u.shape->variable, u.shape->unit),
                       "residual, times noise", 720, 240, 1},
                      {{"", "#bbb", u.shape->middle, low},
                       {"", "#bbb", u.shape->middle, high},
                       {"mean", "#c0392b", u.shape->middle, u.shape->mean}});
  }
  return html;
}

std::string use_of(const Diagnosis& d, const std::string& recording) {
  const bool teaches = std::ranges::count(d.train, recording) > 0,
             judges = std::ranges::count(d.held_out, recording) > 0;
  return std::string(teaches ? "choose and fit" : "") + (teaches && judges ? ", " : "") +
         (judges ? "judge" : "");
}

std::string data(const Diagnosis& d) {
  std::string html = "<h2>Recordings</h2>\n<table><tr><th>file</th><th>used to</th></tr>\n";
  for (const std::string& name : d.recordings)
    html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escaped(name), use_of(d, name));
  html += "</table>\n";
  for (const std::string& warning : d.warnings)
    html += fmt::format("<p class=\"note\">{}</p>\n", escaped(warning));
  return html;
}

}  // namespace

std::string diagnosis_report(const Diagnosis& d, const sim::rehearsal::FreeRun& free_run,
                             const erp::Robot& robot) {
  return head + fmt::format("<h1>{}: where robot and model part</h1>\n", escaped(robot.name)) +
         summary(d) + chains(d) + stages(d) + ranking(d) + moments(d) + free_running(free_run) +
         rest(d) + data(d) + "</body></html>\n";
}

}  // namespace launch
