#pragma once
#include "interfaces/parallel/pool.hpp"

namespace sim {

/// The processes that `mpirun` has started, each with some threads. Part k of a work is done by
/// process k modulo their number. There where a part throws, so does `map`; in the others it throws
/// std::runtime_error.
class Machines final : public Pool {
 public:
  explicit Machines(int threads);
  ~Machines() override;
  Machines(const Machines&) = delete;
  Machines& operator=(const Machines&) = delete;

  std::vector<Numbers> map(std::size_t count,
                           const std::function<Numbers(std::size_t)>& work) const override;
  bool first() const override { return rank_ == 0; }
  std::string from_first(std::string said) const override;

 private:
  Threads threads_;
  int rank_ = 0, ranks_ = 1;
};

}  // namespace sim
