#pragma once
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "sim/learning/training_loop/training_loop.hpp"

/// Runs a training from the command line: progress, interruption by Ctrl-C, learning curve.
namespace launch {

struct TrainingRunOptions {
  std::string folder;  ///< for state.xml, curve.csv, curve.svg and the training result
  int rounds = 0;
  int threads = 1;
  bool resume = false;
  /// True: stop after this round. The checkpoint is written.
  std::function<bool()> interrupted = [] { return false; };
};

/// Trains with a line of progress and remaining time, then draws the curve. False: interrupted; a
/// remark states how to continue. Throws as sim::training_loop::run does.
bool run_training(sim::training_loop::Training& training, const TrainingRunOptions& options,
                  const sim::Pool& pool, std::ostream& remarks);

/// Runs `count` tests after a training, with progress and interruption; returns their results in
/// order. Fewer than `count` results: interrupted; the training result is saved.
std::vector<sim::Pool::Numbers> run_tests(
    std::size_t count, const std::function<sim::Pool::Numbers(std::size_t)>& test,
    const TrainingRunOptions& options, const sim::Pool& pool, std::ostream& remarks);

}  // namespace launch
