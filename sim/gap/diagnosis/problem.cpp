#include "sim/gap/diagnosis/problem.hpp"

namespace sim::diagnosis {

RankingOptions Problem::ranking_options(double from, double to) const {
  RankingOptions ranking{.train = sets.train,
                         .held_out = sets.held_out,
                         .withhold = options.withhold,
                         .threads = options.threads,
                         .pool = options.pool,
                         .seed = options.seed};
  if (to > from)
    ranking.progress = [this, from, to](std::size_t done, std::size_t of) {
      report_progress("effects",
                      from + (to - from) * static_cast<double>(done) / static_cast<double>(of));
    };
  return ranking;
}

}  // namespace sim::diagnosis
