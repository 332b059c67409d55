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

/// Trains to the end on one thread, on two threads, and interrupted after two rounds and resumed. The
/// final state must be identical in all cases. `make` returns the same initial training each time.
template <class Make>
auto run_in_three_ways(const std::string& name, Make make) {
  constexpr int enough = 1000;
  auto one = make(), two = make(), killed = make(), after = make();
  sim::training_loop::run(one, {.folder = folder(name + "_one"), .rounds = enough});
  sim::training_loop::run(two, {.folder = folder(name + "_two"), .rounds = enough},
                          sim::Threads(2));
  CHECK(two.state() == one.state());
  const auto there = folder(name + "_killed");
  sim::training_loop::run(killed,
                          {.folder = there, .rounds = enough, .on_round = [](const auto& training) {
                             return training.rounds() < 2;
                           }});
  CHECK(killed.rounds() == 2);
  sim::training_loop::run(after, {.folder = there, .rounds = enough, .resume = true});
  CHECK(after.state() == one.state());
  for (const char* way : {"_one", "_two", "_killed"}) folder(name + way);
  return one;
}

}  // namespace training_runs
