#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

/// Where the parts of a work are done: on threads, or on those of several machines as well.
///
/// Under `mpirun` each process runs the same program on the same input; they share out the parts of
/// each `map` and all get all of its numbers, so that they stay alike. Only the first one writes.
namespace sim {

class Pool {
 public:
  using Numbers = std::vector<double>;
  virtual ~Pool() = default;
  /// work(k) of each k < count, in their order. An exception comes back when all have ended.
  virtual std::vector<Numbers> map(std::size_t count,
                                   const std::function<Numbers(std::size_t)>& work) const = 0;
  /// This process is the one that writes files and prints.
  virtual bool first() const { return true; }
  /// What the first one says.
  virtual std::string from_first(std::string said) const { return said; }
};

class Threads final : public Pool {
 public:
  explicit Threads(int count = 1) : count_(count) {}
  std::vector<Numbers> map(std::size_t count,
                           const std::function<Numbers(std::size_t)>& work) const override;

 private:
  int count_;
};

/// By a pool, or by so many threads where there is none.
std::vector<Pool::Numbers> map(const Pool* pool, int threads, std::size_t count,
                               const std::function<Pool::Numbers(std::size_t)>& work);

/// Of all that `mpirun` has started, if it has, with so many threads each; else these threads. One
/// a process. Throws std::invalid_argument under mpirun where this was built without MPI.
std::unique_ptr<Pool> make_pool(int threads);

}  // namespace sim
