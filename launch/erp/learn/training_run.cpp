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

/// The text as a single-quoted gnuplot string, which has no escape sequences.
std::string quoted(std::string text) {
  for (std::size_t k = 0; (k = text.find('\'', k)) != std::string::npos; k += 2)
    text.insert(k, "'");
  return "'" + text + "'";
}

/// Draws folder/curve.csv as folder/curve.svg, with one panel per unit. The unit is the end of the
/// name of a metric. Throws the exceptions of `draw`.
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
  bool is_running = true;
  {
    Progress progress(remarks);
    int first_round = -1;  // first round of this run: the progress excludes resumed rounds
    sim::training_loop::run(training,
                            {.folder = options.folder,
                             .rounds = options.rounds,
                             .resume = options.resume,
                             .on_round =
                                 [&](const auto& current) {
                                   if (first_round < 0) first_round = current.rounds() - 1;
                                   progress.show(progress_line(current, options.rounds),
                                                 double(current.rounds() - first_round) /
                                                     double(options.rounds - first_round));
                                   return is_running = !options.interrupted();
                                 }},
                            pool);
  }
  if (!pool.first()) return true;
  draw_curve(training.metrics(), options.folder);
  if (!is_running)
    remarks << fmt::format(
        "interrupted after round {} of {}; continue with the same command and --resume\n",
        training.rounds(), options.rounds);
  return is_running;
}

std::vector<sim::Pool::Numbers> run_tests(
    std::size_t count, const std::function<sim::Pool::Numbers(std::size_t)>& test,
    const TrainingRunOptions& options, const sim::Pool& pool, std::ostream& remarks) {
  constexpr std::size_t batch_size = 16;  // tests between two checks for Ctrl-C; chosen
  std::vector<sim::Pool::Numbers> all;
  bool is_running = true;
  {
    Progress progress(remarks);
    while (is_running && all.size() < count) {
      const std::size_t completed = all.size();
      for (auto& numbers : pool.map(std::min(batch_size, count - completed),
                                    [&](std::size_t k) { return test(completed + k); }))
        all.push_back(std::move(numbers));
      progress.show(fmt::format("test {} of {}", all.size(), count),
                    double(all.size()) / double(count));
      is_running = pool.broadcast(pool.first() && options.interrupted() ? "" : "on") == "on";
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
