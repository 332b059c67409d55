#include <fmt/format.h>

#include <algorithm>

#include "interfaces/xml/writer.hpp"
#include "launch/erp/gap/report_parts.hpp"
#include "launch/erp/gap/svg.hpp"

namespace launch::gap {

using namespace sim::diagnosis;
using xml::escaped;

namespace {

/// Number of stages with the same share as this one, including it. The sensors cannot distinguish
/// them.
std::ptrdiff_t group_size(const Diagnosis& d, const Attribution& one) {
  return std::ranges::count_if(d.where, [&](const Attribution& p) { return p.share == one.share; });
}

/// Names of the stages with the largest share, if there are several.
std::string group_text(const Diagnosis& d) {
  std::string names;
  if (d.where.empty() || group_size(d, d.where[0]) < 2) return "";
  for (const Attribution& place : d.where)
    if (place.share == d.where[0].share)
      names += fmt::format("{}{} of {}", names.empty() ? "" : ", ", sim::effects::word(place.stage),
                           escaped(place.on));
  return "<p>The gap is in one of these stages, which the recorded sensors do not distinguish: " +
         names + ".</p>\n";
}

/// Conditions under which the residual is largest. Stages that cannot be distinguished share one
/// sentence.
std::string conditions(const Diagnosis& d) {
  std::string html;
  for (const Attribution& place : d.where) {
    if (place.when.empty()) continue;
    const auto text = fmt::format(
        "{:.0f} % of the residual occurs in the {} fifth of the range of the {}.</p>\n",
        100 * place.when[0].share, place.when[0].fifth, escaped(place.when[0].variable));
    if (html.find(text) == std::string::npos)
      html +=
          fmt::format("<p>{} of {}: {}", sim::effects::word(place.stage), escaped(place.on), text);
  }
  return html;
}

}  // namespace

/// Drawing of the stages of each actuator or joint that has a share of the gap.
std::string page::chains(const Diagnosis& d) {
  const std::vector<std::string> names{"bus",     "motor", "gearbox",  "spindle", "tendon",
                                       "routing", "joint", "skeleton", "sensor"};
  std::vector<std::string> places;
  for (const Attribution& place : d.where)
    if (!std::ranges::count(places, place.on)) places.push_back(place.on);
  std::string html = "<h2>Location of the gap</h2>\n";
  const std::vector<double> zero_shares(names.size(), 0.0);
  const std::vector<std::string> no_notes(names.size(), "–");
  if (places.empty())
    html += svg::chain(d.not_evaluated.empty()
                           ? "the residual of every stage is within its noise"
                           : "the residual of every evaluated stage is within its noise",
                       names, zero_shares, no_notes);
  if (!d.not_evaluated.empty())
    html += fmt::format("<p class=\"note\">Not evaluated: {}.</p>\n",
                        escaped(fmt::format("{}", fmt::join(d.not_evaluated, ", "))));
  for (const std::string& on : places) {
    auto shares = zero_shares;
    auto notes = no_notes;
    for (const Attribution& place : d.where) {
      if (place.on != on || !(place.share > 0)) continue;
      const auto stage = static_cast<std::size_t>(place.stage);
      const auto count = group_size(d, place);
      shares[stage] += place.share;
      notes[stage] = count > 1 ? fmt::format("one of {}", count)
                               : fmt::format("{:.0f} %", 100 * shares[stage]);
    }
    html += svg::chain(on, names, shares, notes);
  }
  return html + group_text(d) + conditions(d);
}

std::string page::worst_windows(const Diagnosis& d) {
  if (d.worst.empty()) return "";
  std::string html =
      "<h2>Largest residuals</h2>\n<p class=\"note\">The green band is twice the noise. A line is "
      "interrupted where the residual cannot be evaluated, for example while a shaft rests.</p>\n";
  for (const WorstWindow& m : d.worst)
    html += svg::plot(
        {fmt::format("{} of {}, {}", sim::effects::word(m.stage), m.on, m.recording), "time, s",
         m.unit, 860, 230, 2 * m.floor},
        {{"before", "#c0392b", m.time_s, m.before}, {"after", "#1e5aa0", m.time_s, m.after}});
  return html;
}

}  // namespace launch::gap
