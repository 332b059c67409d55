#include "sim/gap/diagnosis/problem.hpp"

namespace sim::diagnosis {

RankingOptions Problem::ranking_options(double begin, double end) const {
  RankingOptions ranking{.train = sets.train,
                         .held_out = sets.held_out,
                         .withhold = options.withhold,
                         .threads = options.threads,
                         .pool = options.pool,
                         .seed = options.seed};
  if (end > begin)
    ranking.progress = [this, begin, end](std::size_t done, std::size_t of) {
      report_progress("effects",
                      begin + (end - begin) * static_cast<double>(done) / static_cast<double>(of));
    };
  return ranking;
}

}  // namespace sim::diagnosis
