// Reproduces figure 5 of the paper for each strategy. Models with random errors as large as those
// of the paper are calibrated with a recording of the arm (launch/calibration_tour.xml).
//   erp_calibration TOUR.mcap PICTURE.svg [FIRST_SEED [SEEDS]]
// Exits with 1 if the mean error of the evolution strategy exceeds its limit.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numbers>

#include "interfaces/recording/table.hpp"
#include "interfaces/xml/xml.hpp"
#include "launch/erp/text/gnuplot.hpp"
#include "sim/learning/calibration/perturb.hpp"
#include "sim/learning/calibration/strategy.hpp"

namespace {

using namespace sim::calibration;

constexpr int generations = 250;
constexpr double initial_error_deg[] = {35.7, 32.9};  // shoulder, elbow; from the paper
constexpr double limit_deg[] = {2.5, 1.9, 2.0,
                                1.9};  // training: shoulder, elbow; validation: shoulder, elbow
constexpr std::pair<const char*, Strategy> strategies[] = {
    {"evolution", Strategy::evolution}, {"newton", Strategy::newton}, {"cma", Strategy::cma}};

struct Run {
  std::vector<std::vector<double>> curve;  ///< metrics of each round
  double seconds = 0;
};

double clock_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Run calibrate(const Task& task, Strategy strategy, std::uint64_t seed, int threads) {
  const auto calibration = make_calibration(task, {.strategy = strategy, .seed = seed});
  const sim::Threads pool(threads);
  Run run;
  const auto store_metrics = [&] {
    auto& row = run.curve.emplace_back();
    for (const auto& metric : calibration->metrics()) row.push_back(metric.value);
  };
  store_metrics();
  const double begin_s = clock_s();
  while (calibration->rounds() < generations && !calibration->done())
    calibration->round(pool), store_metrics();
  run.seconds = clock_s() - begin_s;
  return run;
}

struct Statistics {
  double mean = 0, deviation = 0, largest = 0;
};

Statistics statistics_of(const std::vector<double>& values) {
  Statistics s;
  for (const double v : values)
    s.mean += v / double(values.size()), s.largest = std::max(s.largest, v);
  for (const double v : values)
    s.deviation += std::pow(v - s.mean, 2) / std::max(1.0, double(values.size()) - 1);
  s.deviation = std::sqrt(s.deviation);
  return s;
}

/// Values of one metric in all runs, at their start or end.
std::vector<double> metric_values(const std::vector<Run>& runs, std::size_t metric, bool at_end) {
  std::vector<double> values;
  for (const Run& run : runs)
    values.push_back((at_end ? run.curve.back() : run.curve.front())[metric]);
  return values;
}

void print(const char* name, const std::vector<Run>& runs, bool at_end) {
  fmt::print("{:<12}", name);
  for (std::size_t m = 0; m < 4; ++m) {
    const Statistics statistics = statistics_of(metric_values(runs, m, at_end));
    fmt::print("  {:5.2f} ± {:4.2f} ({:5.2f})", statistics.mean, statistics.deviation,
               statistics.largest);
  }
  std::vector<double> seconds;
  for (const Run& run : runs) seconds.push_back(run.seconds);
  if (at_end)
    fmt::print("  {:9.0f}  {:6.1f}", statistics_of(metric_values(runs, 4, true)).mean,
               statistics_of(seconds).mean);
  fmt::print("\n");
  std::fflush(stdout);
}

/// Plots the mean error of shoulder and elbow against evaluated poses: one line per seed, one
/// colour per strategy.
launch::PlotScript script(const std::vector<std::vector<Run>>& runs_per_strategy) {
  constexpr const char* colours[] = {"#0072B2", "#D55E00", "#009E73"};
  launch::PlotScript plot{.panels = 2};
  std::string data, lines[2];
  for (std::size_t s = 0; s < runs_per_strategy.size(); ++s)
    for (std::size_t k = 0; k < runs_per_strategy[s].size(); ++k) {
      const std::string name = fmt::format("$run_{}_{}", s, k);
      data += name + " << E\n";
      for (const auto& row : runs_per_strategy[s][k].curve)
        data += fmt::format("{} {} {}\n", std::max(row[4], 15.0), (row[0] + row[1]) / 2,
                            (row[2] + row[3]) / 2);
      data += "E\n";
      for (int panel = 0; panel < 2; ++panel)
        lines[panel] += fmt::format(
            "{} using 1:{} with lines lw 1.5 lc rgb '{}' {}, ", name, 2 + panel, colours[s],
            k ? "notitle" : "title '" + std::string(strategies[s].first) + "'");
    }
  plot.commands =
      data +
      "set grid\nset key outside right\nset logscale xy\nset multiplot layout 2,1 title "
      "'mean of shoulder and elbow, degrees'\nset ylabel 'training poses'\nplot " +
      lines[0] + "\nset ylabel 'validation poses'\nset xlabel 'poses evaluated'\nplot " + lines[1] +
      "\nunset multiplot\n";
  return plot;
}

Task perturbed_task(const std::string& recording, std::uint64_t seed) {
  const std::string arm = ERP_SOURCE_DIR "/configs/arm/";
  const erp::Robot robot = erp::read_robot(arm + "robot.xml");
  const auto choice = xml::read<Choice>(arm + "calibration.xml");
  const auto poses = split(still_poses(recording::read_table(recording), robot));
  const Parameters parameters(robot, choice);
  std::vector<double> errors_rad;
  for (const double deg : initial_error_deg) errors_rad.push_back(deg * std::numbers::pi / 180);
  const auto perturbed_values = perturbed(parameters, poses.learn, errors_rad, seed);
  return {Parameters(parameters.robot_at(perturbed_values), choice), poses};
}

void print_speed(const Task& task) {
  double seconds[2] = {INFINITY, INFINITY};
  for (int repeat = 0; repeat < 3; ++repeat)
    for (int threads : {1, 2}) {
      double& shortest_s = seconds[threads - 1];
      shortest_s = std::min(shortest_s, calibrate(task, Strategy::evolution, 1, threads).seconds);
    }
  fmt::print("full run of 135000 poses: {:.1f} s on one thread, {:.1f} s on two: {:.2f} times\n",
             seconds[0], seconds[1], seconds[0] / seconds[1]);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "erp_calibration TOUR.mcap PICTURE.svg [FIRST_SEED [SEEDS]]\n");
    return 2;
  }
  const std::uint64_t first_seed = argc > 3 ? std::stoull(argv[3]) : 101;
  const int seeds = argc > 4 ? std::stoi(argv[4]) : 10;
  std::vector<Task> tasks;
  for (int k = 0; k < seeds; ++k)
    tasks.push_back(perturbed_task(argv[1], first_seed + std::uint64_t(k)));
  fmt::print(
      "{} seeds from {}; degrees, mean ± standard deviation (maximum)\n{:<12}  {:<21}  {:<21}  "
      "{:<21}  {:<21}  {:>9}  {:>6}\n",
      seeds, first_seed, "", "shoulder, training", "elbow, training", "shoulder, validation",
      "elbow, validation", "evaluated", "s");
  std::vector<std::vector<Run>> runs_per_strategy;
  for (const auto& [name, strategy] : strategies) {
    auto& runs = runs_per_strategy.emplace_back();
    for (int k = 0; k < seeds; ++k)
      runs.push_back(calibrate(tasks[std::size_t(k)], strategy, first_seed + std::uint64_t(k), 2));
    if (runs_per_strategy.size() == 1) print("start", runs, false);
    print(name, runs, true);
  }
  launch::draw(script(runs_per_strategy), argv[2]);
  print_speed(tasks.front());
  for (std::size_t m = 0; m < 4; ++m)
    if (statistics_of(metric_values(runs_per_strategy.front(), m, true)).mean > limit_deg[m])
      return 1;
  return 0;
}
