#pragma once
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "sim/learning/training_loop/learner.hpp"

/// Learning as one watches it: whatever is learnt, it is shown, interrupted and drawn alike.
namespace launch {

struct CourseOptions {
  std::string folder;  ///< of state.xml, curve.csv, curve.svg and what else is learnt
  int rounds = 0;
  int threads = 1;
  bool resume = false;
  /// True: to end after this round; all is kept.
  std::function<bool()> interrupted = [] { return false; };
};

/// Learns, with a line of progress and time left, then draws the curve. False: interrupted; it has
/// said how to go on. Throws what sim::training_loop::learn does.
bool run_course(sim::training_loop::Learner& learner, const CourseOptions& options, const sim::Pool& pool,
                std::ostream& remarks);

/// The parts of what is tested after a course, in their order, shown and interrupted alike; fewer than
/// `count`: interrupted, what is learnt is kept.
std::vector<sim::Pool::Numbers> run_tests(
    std::size_t count, const std::function<sim::Pool::Numbers(std::size_t)>& test,
    const CourseOptions& options, const sim::Pool& pool, std::ostream& remarks);

}  // namespace launch
