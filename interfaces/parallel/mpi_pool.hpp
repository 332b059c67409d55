#pragma once
#include "interfaces/parallel/pool.hpp"

namespace sim {

/// The processes that `mpirun` started, each with several threads. Of n processes, process k mod n
/// computes part k. If a part throws, `map` rethrows its exception in that process and throws
/// std::runtime_error in the others.
class MpiPool final : public Pool {
 public:
  explicit MpiPool(int threads);
  ~MpiPool() override;
  MpiPool(const MpiPool&) = delete;
  MpiPool& operator=(const MpiPool&) = delete;

  std::vector<Numbers> map(std::size_t count,
                           const std::function<Numbers(std::size_t)>& work) const override;
  bool first() const override { return rank_ == 0; }
  std::string broadcast(std::string text) const override;

 private:
  Threads threads_;
  int rank_ = 0, ranks_ = 1;
};

}  // namespace sim
