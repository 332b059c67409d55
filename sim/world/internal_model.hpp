#pragma once
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "sim/world/world.hpp"

/// The simulator as an internal model: N candidates are simulated from one state in parallel
/// worlds. For model-predictive controllers, calibration, diagnosis and learning.
///
///   sim::InternalModel model(robot);
///   auto ends = model.ahead(world.save(), candidates, 50, 0.001);   // 50 ms ahead
///
/// One world per thread. The state is restored before each candidate. The results are therefore
/// equal, bit by bit, for any number of threads.
namespace sim {

class InternalModel {
 public:
  /// `threads` 0: one per processor. Throws as World does.
  explicit InternalModel(const erp::Robot& robot, const WorldOptions& options = {},
                         int threads = 0);
  ~InternalModel();
  InternalModel(const InternalModel&) = delete;
  InternalModel& operator=(const InternalModel&) = delete;

  int threads() const { return static_cast<int>(workers_.size()); }

  /// Calls play(world, k) for each k = 0 … candidates − 1, in a world in state `from`, in any
  /// order, in parallel on all threads. Returns when all calls have returned; rethrows the
  /// exception of the lowest k. Call it from one thread at a time, and not from `play`.
  void each(const WorldState& from, int candidates, const std::function<void(World&, int)>& play);

  /// The final state of each candidate, with its voltages held constant.
  std::vector<WorldState> ahead(const WorldState& from,
                                std::span<const std::vector<double>> voltages_V, int steps,
                                double dt_s);

 private:
  struct Job {
    const WorldState* from = nullptr;
    const std::function<void(World&, int)>* play = nullptr;
    int candidates = 0;
  };
  void stop();
  void work(World& world);
  void run_candidates(World& world, const Job& job);

  std::vector<std::unique_ptr<World>> worlds_;
  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable begin_, done_;
  Job job_;
  long round_ = 0;  ///< number of the current job
  int busy_ = 0;    ///< workers that have not finished it
  bool stopping_ = false;
  std::atomic<int> next_ = 0;
  std::exception_ptr error_;
  int error_candidate_ = 0;  ///< candidate of the exception
};

}  // namespace sim
