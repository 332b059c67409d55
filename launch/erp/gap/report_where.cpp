#include <fmt/format.h>

#include <algorithm>

#include "launch/erp/gap/report_parts.hpp"
#include "launch/erp/gap/svg.hpp"

namespace launch::gap {

using namespace sim::diagnosis;
using svg::escaped;

namespace {

/// How many places share as much as this one, for the sensors cannot tell them apart; it is in it.
std::ptrdiff_t alike(const Diagnosis& d, const Attribution& one) {
  return std::ranges::count_if(d.where, [&](const Attribution& p) { return p.share == one.share; });
}

/// The places that share the largest part.
std::string alike(const Diagnosis& d) {
  std::string names;
  if (d.where.empty() || alike(d, d.where[0]) < 2) return "";
  for (const Attribution& place : d.where)
    if (place.share == d.where[0].share)
      names += fmt::format("{}{} of {}", names.empty() ? "" : ", ", sim::effects::word(place.stage),
                           escaped(place.on));
  return "<p>It is in one of these, which recordings of these sensors do not tell apart: " + names +
         ".</p>\n";
}

/// When the residual lives; once for places that are told apart by nothing.
std::string when(const Diagnosis& d) {
  std::string html;
  for (const Attribution& place : d.where) {
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

}  // namespace

/// The chain of each actuator or joint that has a part of the gap.
std::string page::chains(const Diagnosis& d) {
  const std::vector<std::string> names{"bus",     "motor", "gearbox",  "spindle", "tendon",
                                       "routing", "joint", "skeleton", "sensor"};
  std::vector<std::string> places;
  for (const Attribution& place : d.where)
    if (!std::ranges::count(places, place.on)) places.push_back(place.on);
  std::string html = "<h2>Where</h2>\n";
  const std::vector<double> none(names.size(), 0.0);
  const std::vector<std::string> quiet(names.size(), "–");
  if (places.empty())
    html += svg::chain(d.not_evaluated.empty() ? "every stage is at its floor"
                                               : "every stage that could be judged is at its floor",
                       names, none, quiet);
  if (!d.not_evaluated.empty())
    html += fmt::format("<p class=\"note\">Not judged: {}.</p>\n",
                        escaped(fmt::format("{}", fmt::join(d.not_evaluated, ", "))));
  for (const std::string& on : places) {
    auto shares = none;
    auto notes = quiet;
    for (const Attribution& place : d.where) {
      if (place.on != on || !(place.share > 0)) continue;
      const auto stage = static_cast<std::size_t>(place.stage);
      const auto count = alike(d, place);
      shares[stage] += place.share;
      notes[stage] = count > 1 ? fmt::format("one of {}", count)
                               : fmt::format("{:.0f} %", 100 * shares[stage]);
    }
    html += svg::chain(on, names, shares, notes);
  }
  return html + alike(d) + when(d);
}

std::string page::moments(const Diagnosis& d) {
  if (d.worst.empty()) return "";
  std::string html =
      "<h2>The worst moments</h2>\n<p class=\"note\">The green band is twice the noise; where a "
      "line breaks, a window cannot be judged, as when a shaft rests.</p>\n";
  for (const WorstWindow& m : d.worst)
    html += svg::plot(
        {fmt::format("{} of {}, {}", sim::effects::word(m.stage), m.on, m.recording), "time, s",
         m.unit, 860, 230, 2 * m.floor},
        {{"before", "#c0392b", m.time_s, m.before}, {"after", "#1e5aa0", m.time_s, m.after}});
  return html;
}

}  // namespace launch::gap
