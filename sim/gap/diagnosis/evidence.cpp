#include "sim/gap/diagnosis/evidence.hpp"

namespace sim::diagnosis {

WhichOptions Evidence::which_options(double from, double to) const {
  WhichOptions which{.train = sets.train,
                     .held_out = sets.held_out,
                     .withhold = options.withhold,
                     .threads = options.threads,
                     .pool = options.pool,
                     .seed = options.seed};
  if (to > from)
    which.progress = [this, from, to](std::size_t done, std::size_t of) {
      tell("effects", from + (to - from) * static_cast<double>(done) / static_cast<double>(of));
    };
  return which;
}

}  // namespace sim::diagnosis
