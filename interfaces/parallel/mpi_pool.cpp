#include "interfaces/parallel/mpi_pool.hpp"

#include <mpi.h>

#include <exception>
#include <numeric>
#include <stdexcept>

namespace sim {
namespace {

/// The vectors of all processes, concatenated in the order of their ranks.
template <class Number>
std::vector<Number> gathered(const std::vector<Number>& mine, MPI_Datatype type, int ranks) {
  int size = static_cast<int>(mine.size());
  std::vector<int> sizes(static_cast<std::size_t>(ranks)), begins(sizes.size());
  MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, MPI_COMM_WORLD);
  std::exclusive_scan(sizes.begin(), sizes.end(), begins.begin(), 0);
  std::vector<Number> all(std::accumulate(sizes.begin(), sizes.end(), std::size_t{}));
  MPI_Allgatherv(mine.data(), size, type, all.data(), sizes.data(), begins.data(), type,
                 MPI_COMM_WORLD);
  return all;
}

}  // namespace

MpiPool::MpiPool(int threads) : threads_(threads) {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
}
/// Does not finalize during an exception: mpirun then ends the other processes, which would wait
/// forever otherwise.
MpiPool::~MpiPool() {
  if (std::uncaught_exceptions() == 0) MPI_Finalize();
}

std::vector<Pool::Numbers> MpiPool::map(std::size_t count,
                                        const std::function<Numbers(std::size_t)>& work) const {
  const auto rank = static_cast<std::size_t>(rank_), ranks = static_cast<std::size_t>(ranks_);
  const auto part_count = [&](std::size_t r) {
    return count / ranks + (r < count % ranks ? 1 : 0);
  };
  std::vector<Numbers> mine;
  std::exception_ptr failure;
  try {
    mine = threads_.map(part_count(rank), [&](std::size_t k) { return work(rank + k * ranks); });
  } catch (...) {
    failure = std::current_exception();
  }
  int failed = failure ? 1 : 0, any_failed = 0;
  MPI_Allreduce(&failed, &any_failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  if (failure) std::rethrow_exception(failure);
  if (any_failed)
    throw std::runtime_error("another process of this mpirun has failed; see its message");

  std::vector<int> my_sizes;
  Numbers my_numbers;
  for (const Numbers& part : mine) {
    my_sizes.push_back(static_cast<int>(part.size()));
    my_numbers.insert(my_numbers.end(), part.begin(), part.end());
  }
  const auto sizes = gathered(my_sizes, MPI_INT, ranks_);
  const auto numbers = gathered(my_numbers, MPI_DOUBLE, ranks_);
  std::vector<Numbers> all(count);
  auto size = sizes.begin();
  auto number = numbers.begin();
  for (std::size_t r = 0; r < ranks; ++r)
    for (std::size_t k = r; k < count; k += ranks) {
      all[k].assign(number, number + *size);
      number += *size++;
    }
  return all;
}

std::string MpiPool::broadcast(std::string text) const {
  int size = static_cast<int>(text.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, MPI_COMM_WORLD);
  text.resize(static_cast<std::size_t>(size));
  MPI_Bcast(text.data(), size, MPI_CHAR, 0, MPI_COMM_WORLD);
  return text;
}

}  // namespace sim
