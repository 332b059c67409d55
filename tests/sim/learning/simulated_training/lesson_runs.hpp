#pragma once
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "sim/learning/training_loop/learner.hpp"

namespace lessons {

inline std::string folder(const std::string& name) {
  const auto path = std::filesystem::temp_directory_path() / ("erp_lesson_" + name);
  std::filesystem::remove_all(path);
  return path.string();
}

/// Learns to the end on one thread; then on two, and broken off after a round and gone on with: what is
/// learnt must be the same, to the last digit. `make` makes the same lesson each time.
template <class Make>
auto run_in_three_ways(const std::string& name, Make make) {
  constexpr int enough = 1000;
  auto one = make(), two = make(), killed = make(), after = make();
  sim::training_loop::learn(one, {.folder = folder(name + "_one"), .rounds = enough});
  sim::training_loop::learn(two, {.folder = folder(name + "_two"), .rounds = enough}, sim::Threads(2));
  CHECK(two.state() == one.state());
  const auto there = folder(name + "_killed");
  sim::training_loop::learn(killed, {.folder = there, .rounds = enough, .told = [](const auto& lesson) {
                                 return lesson.rounds() < 2;
                               }});
  CHECK(killed.rounds() == 2);
  sim::training_loop::learn(after, {.folder = there, .rounds = enough, .resume = true});
  CHECK(after.state() == one.state());
  for (const char* way : {"_one", "_two", "_killed"}) folder(name + way);
  return one;
}

}  // namespace lessons
