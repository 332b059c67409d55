#include "interfaces/parallel/pool.hpp"

#include <cstdlib>
#include <stdexcept>

#include "interfaces/parallel/in_parallel.hpp"
#ifdef ERP_WITH_MPI
#include "interfaces/parallel/mpi_pool.hpp"
#endif

namespace sim {

std::vector<Pool::Numbers> Threads::map(std::size_t count,
                                        const std::function<Numbers(std::size_t)>& work) const {
  std::vector<Numbers> all(count);
  in_parallel(count, count_, [&](std::size_t k) { all[k] = work(k); });
  return all;
}

std::vector<Pool::Numbers> map(const Pool* pool, int threads, std::size_t count,
                               const std::function<Pool::Numbers(std::size_t)>& work) {
  return pool ? pool->map(count, work) : Threads(threads).map(count, work);
}

std::unique_ptr<Pool> make_pool(int threads) {
  const char* size = std::getenv("OMPI_COMM_WORLD_SIZE");
  if (!size || std::atoi(size) < 2) return std::make_unique<Threads>(threads);
#ifdef ERP_WITH_MPI
  return std::make_unique<MpiPool>(threads);
#else
  throw std::invalid_argument(
      "this erp was built without MPI; install libopenmpi-dev and build again, or run it without "
      "mpirun");
#endif
}

}  // namespace sim
