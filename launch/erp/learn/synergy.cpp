#include "launch/erp/learn/learn.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <ostream>

#include "interfaces/xml/xml.hpp"
#include "launch/erp/learn/task_poses.hpp"
#include "launch/erp/text/gnuplot.hpp"
#include "launch/erp/text/text_files.hpp"
#include "sim/learning/simulated_training/synergy_training.hpp"

namespace launch {
namespace {

using sim::simulated_training::SynergyTraining;
using Test = SynergyTraining::Test;

constexpr std::array bank_fractions{1.0, 0.5, 0.25, 0.1};

/// A bank with a fraction `share` of the plans, and its tests.
struct TestedBank {
  double share;
  sim::synergy::Bank bank;
  std::vector<Test> tests;
};

std::vector<double> numbers_of(const Test& test) {
  const auto& o = test.outcome;
  return {test.target_m.x(),
          test.target_m.y(),
          test.target_m.z(),
          test.returned ? 1.0 : 0.0,
          o.struck ? 1.0 : 0.0,
          o.nearest_m,
          o.strike_s,
          o.strike_speed_m_per_s,
          o.stayed,
          o.reward,
          test.relative_jerk};
}

Test test_of(const std::vector<double>& n) {
  return {{n[0], n[1], n[2]}, n[3] != 0, {n[4] != 0, n[5], n[6], n[7], n[8], n[9]}, n[10]};
}

/// Tests the bank with each fraction of its plans. Returns an empty list if interrupted.
std::vector<TestedBank> test_banks(const SynergyTraining& training, std::uint64_t seed,
                                   const SynergyOptions& options, const sim::Pool& pool,
                                   std::ostream& remarks) {
  std::vector<TestedBank> results;
  for (const double share : bank_fractions) {
    results.push_back({.share = share, .bank = training.bank(), .tests = {}});
    results.back().bank.cut(
        static_cast<std::size_t>(share * double(training.bank().plans().size()) + 0.5));
  }
  const auto count = static_cast<std::size_t>(options.tests);
  const auto numbers = run_tests(
      count * results.size(),
      [&](std::size_t k) {
        return numbers_of(training.test(results[k / count].bank, seed, k % count));
      },
      options.training, pool, remarks);
  if (numbers.size() < count * results.size()) return {};
  for (std::size_t k = 0; k < numbers.size(); ++k)
    results[k / count].tests.push_back(test_of(numbers[k]));
  return results;
}

double struck_percent(const std::vector<Test>& tests, double from_m = -HUGE_VAL,
                      double to_m = HUGE_VAL) {
  int struck = 0, count = 0;
  for (const Test& test : tests)
    if (test.target_m.z() >= from_m && test.target_m.z() < to_m)
      ++count, struck += test.outcome.struck;
  return count > 0 ? 100.0 * struck / count : 0;
}

double returned_percent(const std::vector<Test>& tests) {
  return 100.0 * static_cast<double>(std::ranges::count_if(tests, &Test::returned)) /
         static_cast<double>(tests.size());
}

double median(std::vector<double> numbers) {
  if (numbers.empty()) return 0;
  const auto k = static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::ranges::nth_element(numbers, numbers.begin() + k);
  return numbers[static_cast<std::size_t>(k)];
}

void print_heights(const std::vector<Test>& tests, std::ostream& out) {
  std::vector<double> heights_m;
  for (const Test& test : tests) heights_m.push_back(test.target_m.z());
  const auto [low, high] = std::ranges::minmax(heights_m);
  constexpr int bands = 3;
  for (int k = 0; k < bands; ++k) {
    const double from_m = low + k * (high - low) / bands;
    const double to_m = k + 1 < bands ? low + (k + 1) * (high - low) / bands : HUGE_VAL;
    out << fmt::format("  from {:+.2f} m{:>8.1f} %\n", from_m, struck_percent(tests, from_m, to_m));
  }
}

void print(const std::vector<TestedBank>& results, std::ostream& out) {
  const auto& tests = results.front().tests;
  std::vector<double> speeds, stayed, jerks;
  for (const Test& test : tests) {
    if (test.outcome.struck) speeds.push_back(test.outcome.strike_speed_m_per_s);
    stayed.push_back(100 * test.outcome.stayed), jerks.push_back(test.relative_jerk);
  }
  out << fmt::format("{} new targets, struck{:>7.1f} %; by height:\n", tests.size(),
                     struck_percent(tests));
  print_heights(tests, out);
  out << fmt::format(
      "medians: hand speed at the strike {:.3f} m/s, {:.0f} % of the time after the signal in the "
      "zone, "
      "jerk {:.1f} times the minimum\n",
      median(speeds), median(stayed), median(jerks));
  constexpr double explained_variance = 0.9;  // fraction of the weights' sum of squares; chosen
  for (const TestedBank& result : results)
    out << fmt::format(
        "{:>4.0f} % of the bank, {:>3} plans, {:>2} synergies (90 %): struck{:>6.1f} %, "
        "returned{:>6.1f} %\n",
        100 * result.share, result.bank.plans().size(), components(result.bank, explained_variance),
        struck_percent(result.tests), returned_percent(result.tests));
}

std::string csv_of(const std::vector<TestedBank>& results) {
  std::string text =
      "share,target_x_m,target_y_m,target_z_m,returned,struck,nearest_m,"
      "strike_s,strike_speed_m_per_s,stayed,reward,relative_jerk\n";
  for (const TestedBank& result : results)
    for (const Test& test : result.tests) {
      text += fmt::format("{}", result.share);
      for (const double number : numbers_of(test)) text += fmt::format(",{:.6g}", number);
      text += '\n';
    }
  return text;
}

/// Writes each reduced bank to its own file.
void write_parts(const std::vector<TestedBank>& results, const sim::synergy::BankFile& file,
                 const std::string& folder) {
  for (const TestedBank& part : results)
    if (part.share < 1)
      write_file(fmt::format("{}/bank_{:.0f}.xml", folder, 100 * part.share),
                 text_of(file, part.bank));
}

/// Three panels: struck and missed targets from the side and from above, and the success rate by
/// number of plans.
PlotScript figure(const std::vector<TestedBank>& results) {
  std::string data = "$t << E\n";
  for (const Test& test : results.front().tests)
    data += fmt::format("{} {} {} {}\n", test.target_m.x(), test.target_m.y(), test.target_m.z(),
                        test.outcome.struck ? 1 : 0);
  data += "E\n$b << E\n";
  for (const TestedBank& result : results)
    data += fmt::format("{} {}\n", result.bank.plans().size(), struck_percent(result.tests));
  data += "E\n";
  const auto view = [](const char* title, int horizontal, int vertical, const char* x,
                       const char* y) {
    return fmt::format(
        "set title '{0}'\nset xlabel '{3} m'\nset ylabel '{4} m'\n"
        "plot $t using {1}:($4 > 0 ? ${2} : 1/0) with points pt 7 ps 0.8 lc rgb '#0072B2' title "
        "'struck', "
        "$t using {1}:($4 > 0 ? 1/0 : ${2}) with points pt 2 ps 0.9 lw 2 lc rgb '#D55E00' title "
        "'missed'\n",
        title, horizontal, vertical, x, y);
  };
  return {.commands = data +
                      "set multiplot layout 1,3\nset grid\nset key below\nset size ratio -1\n" +
                      view("from the side", 1, 3, "x", "z") + view("from above", 1, 2, "x", "y") +
                      "set size noratio\nset title 'reduced bank'\nset xlabel 'plans'\n"
                      "set ylabel 'struck %'\nset yrange [0:100]\nset logscale x 2\n"
                      "plot $b using 1:2 with linespoints lw 2 pt 7 lc rgb '#0072B2' notitle\n"
                      "unset multiplot\n",
          .panels = 2};
}

}  // namespace

int learn_synergy(const SynergyOptions& options, std::ostream& out, std::ostream& remarks) {
  const auto pool = sim::make_pool(options.training.threads);
  const erp::Robot robot = erp::read_robot(options.robot);
  auto task = xml::read<sim::synergy::Task>(options.task);
  if (options.seed != 0) task.seed = options.seed;
  SynergyTraining training(robot, task, task_poses(options.task, task.poses, robot));
  TrainingRunOptions run = options.training;
  run.rounds = task.rounds;
  if (!run_training(training, run, *pool, remarks)) return 1;
  if (pool->first()) write_file(run.folder + "/bank.xml", training.state());
  if (options.tests > 0) {
    const auto results =
        test_banks(training, static_cast<std::uint64_t>(task.seed), options, *pool, remarks);
    if (results.empty()) return 1;
    if (!pool->first()) return 0;
    write_file(run.folder + "/tests.csv", csv_of(results));
    write_parts(results, training.file(), run.folder);
    draw(figure(results), run.folder + "/figure.svg");
    print(results, out);
  }
  if (!pool->first()) return 0;
  out << fmt::format("{}/bank.xml is the bank for the component synergy{}\n", run.folder,
                     options.tests > 0 ? "; bank_25.xml has a quarter of its plans" : "");
  return 0;
}

}  // namespace launch
