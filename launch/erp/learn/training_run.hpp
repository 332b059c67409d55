#pragma once
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "sim/learning/training_loop/training_loop.hpp"

/// Runs a training from the command line, with progress, interruption by Ctrl-C and a learning
/// curve.
namespace launch {

struct TrainingRunOptions {
  std::string folder;  ///< for state.xml, curve.csv, curve.svg and the training result
  int rounds = 0;
  int threads = 1;
  bool resume = false;
  /// Returns true if the training should stop after this round. The checkpoint is written in any
  /// case.
  std::function<bool()> interrupted = [] { return false; };
};

/// Trains, shows progress and remaining time, then draws the curve. Returns false if interrupted; a
/// remark then states how to continue. Throws the exceptions of sim::training_loop::run.
bool run_training(sim::training_loop::Training& training, const TrainingRunOptions& options,
                  const sim::Pool& pool, std::ostream& remarks);

/// Runs `count` tests after a training and shows progress. Returns their results in order; if
/// interrupted, fewer than `count`.
std::vector<sim::Pool::Numbers> run_tests(
    std::size_t count, const std::function<sim::Pool::Numbers(std::size_t)>& test,
    const TrainingRunOptions& options, const sim::Pool& pool, std::ostream& remarks);

}  // namespace launch
