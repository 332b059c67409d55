#pragma once
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace sim {

/// Calls work(k) for each k < count on `threads` threads, including the calling one. After all
/// calls have ended, rethrows the exception of the smallest k that failed.
template <class Work>
void in_parallel(std::size_t count, int threads, Work work) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::exception_ptr> failures(count);
  const auto run = [&] {
    for (std::size_t k; (k = next++) < count;) try {
        work(k);
      } catch (...) {
        failures[k] = std::current_exception();
      }
  };
  {
    std::vector<std::jthread> workers;
    for (int t = 1; t < threads; ++t) workers.emplace_back(run);
    run();
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace sim
