#include <fmt/format.h>

#include <cmath>

#include "interfaces/xml/writer.hpp"
#include "launch/erp/gap/messages.hpp"
#include "launch/erp/gap/report_parts.hpp"
#include "launch/erp/gap/svg.hpp"
#include "sim/gap/estimation/as_built.hpp"

namespace launch::gap {

using namespace sim::diagnosis;
using xml::escaped;

std::string page::name_of(const IdentifiedEffect& effect) {
  return effect.type + " on " + effect.on;
}

std::string page::ranking(const Diagnosis& d) {
  if (d.ranked.empty()) return "";
  constexpr std::size_t max_effects = 14;  // bars; chosen
  std::vector<svg::Bar> bars;
  std::vector<std::string> rows, columns;
  std::vector<std::vector<double>> cells;
  for (const StageGap& gap : d.stages)
    columns.push_back(fmt::format("{} {}", sim::effects::word(gap.stage), gap.on));
  for (std::size_t k = 0; k < d.ranked.size() && k < max_effects; ++k) {
    const IdentifiedEffect& effect = d.ranked[k];
    bars.push_back({name_of(effect), fmt::format("{:.1f} %", 100 * effect.gain), effect.gain,
                    effect.gain_interval.low, effect.gain_interval.high, effect.supported});
    constexpr std::size_t max_columns = 24;  // width of the page
    if (effect.signature.empty() || columns.size() > max_columns) continue;
    rows.push_back(name_of(effect)), cells.push_back(effect.signature);
    cells.back().push_back(std::abs(effect.similarity));
  }
  columns.push_back("similarity to the first");
  std::string html =
      "<h2>Candidate effects</h2>\n<p class=\"note\">Each effect alone, added to the robot as "
      "described. Effects that remove 30 % of the excess of a stage come first; of equal effects "
      "the simpler one comes first." +
      std::string(d.as_built && d.answer.empty()
                      ? " None is part of the answer, which consists of constants."
                      : "") +
      "</p>\n" + svg::bars("Gap closure of each effect alone on " + validation_data(d), bars, 1);
  if (!rows.empty())
    html += svg::matrix(
        "Signatures: share of the change that an effect causes at each stage, in percent", rows,
        columns, cells);
  return html;
}

namespace {

std::string row_of(const ConstantEstimate& c) {
  const char* remark = c.beyond ? "beyond its tolerance"
                       : c.determined < sim::estimation::determined_threshold ? "not determined"
                                                                              : "";
  return fmt::format(
      "<tr><td>{}</td><td>{}</td><td>{:.4g}</td><td>{:.4g}</td><td>{:.4g} … "
      "{:.4g}</td><td>{}</td></tr>\n",
      escaped(c.on), c.name, c.nominal, c.value, c.interval.low, c.interval.high, remark);
}

template <class Shown>
std::string table_of(const std::vector<ConstantEstimate>& constants, Shown is_shown) {
  std::string rows;
  for (const ConstantEstimate& c : constants)
    if (is_shown(c)) rows += row_of(c);
  if (rows.empty()) return "<p>None.</p>\n";
  return "<table><tr><th>on</th><th>constant</th><th>robot.xml</th><th>estimate</th><th>95 % "
         "interval</th><th></th></tr>\n" +
         rows + "</table>\n";
}

}  // namespace

std::string page::constants(const Diagnosis& d) {
  if (d.constants.empty()) return "";
  return "<h2>Constants</h2>\n<p class=\"note\">All constants are estimated jointly, with their "
         "tolerances as prior. Constants that deviate from robot.xml:</p>\n" +
         table_of(d.constants, [](const auto& c) { return c.beyond || deviates(c); }) +
         fmt::format("<details><summary>All {} constants</summary>\n", d.constants.size()) +
         table_of(d.constants, [](const auto&) { return true; }) + "</details>\n";
}

std::string page::unexplained(const Diagnosis& d) {
  if (d.unexplained.empty()) return "";
  std::string html = "<h2>Unexplained residuals</h2>\n";
  if (d.verdict == Verdict::supported)
    html +=
        "<p>These residuals are small compared with the explained gap, but exceed the noise:</p>\n";
  for (const Unexplained& u : d.unexplained) {
    html += fmt::format("<p>{} of {}: residual {:.3g} times its noise.",
                        sim::effects::word(u.stage), escaped(u.on), std::sqrt(1 + u.excess));
    if (!u.shape) {
      html += "</p>\n";
      continue;
    }
    html += fmt::format(
        " A function of the {} predicts {:.0f} % of it, a constant {:.0f} %. Grey: standard "
        "deviation; green: noise.</p>\n",
        escaped(u.shape->variable), 100 * std::max(0.0, u.shape->explained),
        100 * u.shape->constant);
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

}  // namespace launch::gap
