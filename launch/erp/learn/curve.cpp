#include "launch/erp/learn/curve.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "launch/erp/text/gnuplot.hpp"

namespace launch {
namespace {

/// "elbow.learned_deg" → "deg".
std::string unit_of(const std::string& metric) {
  return metric.substr(metric.find_last_of('_') + 1);
}

/// A gnuplot string in which nothing is interpreted.
std::string quoted(std::string text) {
  for (std::size_t k = 0; (k = text.find('\'', k)) != std::string::npos; k += 2)
    text.insert(k, "'");
  return "'" + text + "'";
}

}  // namespace

void draw_curve(const std::vector<sim::training_loop::Metric>& metrics, const std::string& folder) {
  std::vector<std::string> units;
  for (const auto& metric : metrics)
    if (std::ranges::find(units, unit_of(metric.name)) == units.end())
      units.push_back(unit_of(metric.name));

  PlotScript plot{.panels = static_cast<int>(units.size())};
  plot.commands = fmt::format(
      "set datafile separator ','\nset grid\nset key outside right\nset lmargin 12\nset rmargin "
      "30\nset multiplot layout {},1\n"
      "set yrange [0:*]\n",
      units.size());
  for (const std::string& unit : units) {
    plot.commands += "set ylabel " + quoted(unit) + "\n" +
                     (unit == units.back() ? "set xlabel 'round'\n" : "") + "plot ";
    for (std::size_t k = 0; k < metrics.size(); ++k)
      if (unit_of(metrics[k].name) == unit)
        plot.commands += fmt::format("{} using 1:{} every ::1 with lines lw 2 title {}, ",
                                     quoted(folder + "/curve.csv"), k + 2, quoted(metrics[k].name));
    plot.commands += "\n";
  }
  plot.commands += "unset multiplot\n";
  draw(plot, folder + "/curve.svg");
}

}  // namespace launch
