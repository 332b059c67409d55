#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

/// Distributes the parts of a computation over threads, or over processes on several machines.
///
/// Under `mpirun` each process runs the same program on the same input. The processes divide the
/// parts of each `map`. Each process receives all numbers of the result: the states of the
/// processes stay equal. Only the first process writes files and prints.
namespace sim {

class Pool {
 public:
  using Numbers = std::vector<double>;
  virtual ~Pool() = default;
  /// Returns work(k) for each k < count, in the order of k. If a part throws, rethrows its
  /// exception after all parts have ended.
  virtual std::vector<Numbers> map(std::size_t count,
                                   const std::function<Numbers(std::size_t)>& work) const = 0;
  /// Whether this process writes files and prints.
  virtual bool first() const { return true; }
  /// Returns the text of the first process, in every process.
  virtual std::string broadcast(std::string text) const { return text; }
};

class Threads final : public Pool {
 public:
  explicit Threads(int count = 1) : count_(count) {}
  std::vector<Numbers> map(std::size_t count,
                           const std::function<Numbers(std::size_t)>& work) const override;

 private:
  int count_;
};

/// Pool::map of `pool`; with null, of a pool of `threads` threads.
std::vector<Pool::Numbers> map(const Pool* pool, int threads, std::size_t count,
                               const std::function<Pool::Numbers(std::size_t)>& work);

/// Under `mpirun`: a pool of all its processes, with `threads` threads each; otherwise a pool of
/// threads. Create at most one per process. Throws std::invalid_argument under mpirun if this
/// program was built without MPI.
std::unique_ptr<Pool> make_pool(int threads);

}  // namespace sim
