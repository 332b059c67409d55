#pragma once
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "sim/learning/training_loop/training_loop.hpp"

namespace training_runs {

inline std::string folder(const std::string& name) {
  const auto path = std::filesystem::temp_directory_path() / ("erp_training_" + name);
  std::filesystem::remove_all(path);
  return path.string();
}

/// Trains to the end on one thread, on two threads, and interrupted after two rounds and resumed.
/// The final state must be identical in all cases. `make` returns the same initial training each
/// time.
template <class Make>
auto run_in_three_ways(const std::string& name, Make make) {
  constexpr int max_rounds = 1000;
  auto one_thread = make(), two_threads = make(), interrupted = make(), resumed = make();
  sim::training_loop::run(one_thread, {.folder = folder(name + "_one"), .rounds = max_rounds});
  sim::training_loop::run(two_threads, {.folder = folder(name + "_two"), .rounds = max_rounds},
                          sim::Threads(2));
  CHECK(two_threads.state() == one_thread.state());
  const auto folder_path = folder(name + "_killed");
  sim::training_loop::run(interrupted,
                          {.folder = folder_path,
                           .rounds = max_rounds,
                           .on_round = [](const auto& training) { return training.rounds() < 2; }});
  CHECK(interrupted.rounds() == 2);
  sim::training_loop::run(resumed, {.folder = folder_path, .rounds = max_rounds, .resume = true});
  CHECK(resumed.state() == one_thread.state());
  for (const char* suffix : {"_one", "_two", "_killed"}) folder(name + suffix);
  return one_thread;
}

}  // namespace training_runs
