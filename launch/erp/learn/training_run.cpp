#include "launch/erp/learn/training_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <ostream>

#include "launch/erp/text/gnuplot.hpp"
#include "launch/erp/text/progress.hpp"

namespace launch {
namespace {

std::string progress_line(const sim::training_loop::Training& training, int rounds) {
  std::string line = fmt::format("round {} of {}", training.rounds(), rounds);
  for (const auto& metric : training.metrics())
    line += fmt::format("  {} {:.4g}", metric.name, metric.value);
  return line;
}

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

/// Draws folder/curve.csv as folder/curve.svg, with one panel for each unit at the end of the
/// metrics' names. Throws as `draw`.
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

}  // namespace

bool run_training(sim::training_loop::Training& training, const TrainingRunOptions& options,
                  const sim::Pool& pool, std::ostream& remarks) {
  bool on = true;
  {
    Progress progress(remarks);
    int first = -1;  // first round of this run; resumed rounds took no time
    sim::training_loop::run(
        training,
        {.folder = options.folder,
         .rounds = options.rounds,
         .resume = options.resume,
         .on_round =
             [&](const auto& now) {
               if (first < 0) first = now.rounds() - 1;
               progress.show(progress_line(now, options.rounds),
                             double(now.rounds() - first) / double(options.rounds - first));
               return on = !options.interrupted();
             }},
        pool);
  }
  if (!pool.first()) return true;
  draw_curve(training.metrics(), options.folder);
  if (!on)
    remarks << fmt::format(
        "interrupted after round {} of {}; continue with the same command and --resume\n",
        training.rounds(), options.rounds);
  return on;
}

std::vector<sim::Pool::Numbers> run_tests(
    std::size_t count, const std::function<sim::Pool::Numbers(std::size_t)>& test,
    const TrainingRunOptions& options, const sim::Pool& pool, std::ostream& remarks) {
  constexpr std::size_t at_once = 16;  // tests between two checks for Ctrl-C; chosen
  std::vector<sim::Pool::Numbers> all;
  bool on = true;
  {
    Progress progress(remarks);
    while (on && all.size() < count) {
      const std::size_t done = all.size();
      for (auto& numbers :
           pool.map(std::min(at_once, count - done), [&](std::size_t k) { return test(done + k); }))
        all.push_back(std::move(numbers));
      progress.show(fmt::format("test {} of {}", all.size(), count),
                    double(all.size()) / double(count));
      on = pool.broadcast(pool.first() && options.interrupted() ? "" : "on") == "on";
    }
  }
  if (pool.first() && all.size() < count)
    remarks << fmt::format(
        "interrupted after test {} of {}; the training result is saved. Repeat the tests with "
        "the same command and --resume\n",
        all.size(), count);
  return all;
}

}  // namespace launch
