#include "launch/erp/learn/course.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <ostream>

#include "launch/erp/learn/curve.hpp"
#include "launch/erp/text/progress.hpp"

namespace launch {
namespace {

std::string told(const sim::training_loop::Learner& learner, int rounds) {
  std::string line = fmt::format("round {} of {}", learner.rounds(), rounds);
  for (const auto& metric : learner.metrics())
    line += fmt::format("  {} {:.4g}", metric.name, metric.value);
  return line;
}

}  // namespace

bool run_course(sim::training_loop::Learner& learner, const CourseOptions& options, const sim::Pool& pool,
                std::ostream& remarks) {
  bool on = true;
  {
    Progress progress(remarks);
    int first = -1;  // of this run: what was resumed has cost no time
    sim::training_loop::learn(learner,
                        {.folder = options.folder,
                         .rounds = options.rounds,
                         .resume = options.resume,
                         .told =
                             [&](const auto& now) {
                               if (first < 0) first = now.rounds() - 1;
                               progress.tell(
                                   told(now, options.rounds),
                                   double(now.rounds() - first) / double(options.rounds - first));
                               return on = !options.interrupted();
                             }},
                        pool);
  }
  if (!pool.first()) return true;
  draw_curve(learner.metrics(), options.folder);
  if (!on)
    remarks << fmt::format(
        "interrupted after round {} of {}; go on with the same command and --resume\n",
        learner.rounds(), options.rounds);
  return on;
}

std::vector<sim::Pool::Numbers> run_tests(
    std::size_t count, const std::function<sim::Pool::Numbers(std::size_t)>& test,
    const CourseOptions& options, const sim::Pool& pool, std::ostream& remarks) {
  constexpr std::size_t at_once = 16;  // between two looks at Ctrl-C; chosen
  std::vector<sim::Pool::Numbers> all;
  bool on = true;
  {
    Progress progress(remarks);
    while (on && all.size() < count) {
      const std::size_t done = all.size();
      for (auto& numbers :
           pool.map(std::min(at_once, count - done), [&](std::size_t k) { return test(done + k); }))
        all.push_back(std::move(numbers));
      progress.tell(fmt::format("test {} of {}", all.size(), count),
                    double(all.size()) / double(count));
      on = pool.from_first(pool.first() && options.interrupted() ? "" : "on") == "on";
    }
  }
  if (pool.first() && all.size() < count)
    remarks << fmt::format(
        "interrupted after test {} of {}; what is learnt is kept: test it with "
        "the same command and --resume\n",
        all.size(), count);
  return all;
}

}  // namespace launch
