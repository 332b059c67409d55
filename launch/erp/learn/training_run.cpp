#include "launch/erp/learn/training_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <ostream>

#include "launch/erp/learn/curve.hpp"
#include "launch/erp/text/progress.hpp"

namespace launch {
namespace {

std::string progress_line(const sim::training_loop::Training& training, int rounds) {
  std::string line = fmt::format("round {} of {}", training.rounds(), rounds);
  for (const auto& metric : training.metrics())
    line += fmt::format("  {} {:.4g}", metric.name, metric.value);
  return line;
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
