#include "launch/learn/course.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <ostream>

#include "launch/learn/curve.hpp"
#include "launch/text/progress.hpp"

namespace launch {
namespace {

std::string told(const sim::learner::Learner& learner, int rounds) {
  std::string line = fmt::format("round {} of {}", learner.rounds(), rounds);
  for (const auto& metric : learner.metrics())
    line += fmt::format("  {} {:.4g}", metric.name, metric.value);
  return line;
}

}  // namespace

bool run_course(sim::learner::Learner& learner, const CourseOptions& options, const sim::Pool& pool,
                std::ostream& remarks) {
  bool on = true;
  {
    Progress progress(remarks);
    int first = -1;  // of this run: what was resumed has cost no time
    sim::learner::learn(learner,
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

}  // namespace launch
