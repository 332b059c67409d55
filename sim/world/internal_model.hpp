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

/// The simulator as an internal model: from a state, N candidates are tried ahead in parallel
/// worlds. For predicting controllers, calibration, diagnosis and learning.
///
///   sim::InternalModel model(robot);
///   auto ends = model.ahead(world.save(), candidates, 50, 0.001);   // 50 ms ahead
///
/// One world a thread; each candidate begins with the state put into its world, so what comes out
/// is the same bit by bit for any number of threads.
namespace sim {

class InternalModel {
 public:
  /// `threads` 0: one a processor. Throws as World does.
  explicit InternalModel(const erp::Robot& robot, const WorldOptions& options = {},
                         int threads = 0);
  ~InternalModel();
  InternalModel(const InternalModel&) = delete;
  InternalModel& operator=(const InternalModel&) = delete;

  int threads() const { return static_cast<int>(workers_.size()); }

  /// Calls play(world, k) for each k = 0 … candidates − 1, in a world that stands in `from`; in any
  /// order, so many at a time as there are threads. Returns when all are through; what a play threw
  /// is thrown here, that of the lowest k. To be called by one thread at a time, not out of a play.
  void each(const WorldState& from, int candidates, const std::function<void(World&, int)>& play);

  /// Where each candidate's voltages, held, lead to.
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
  void take_part(World& world, const Job& job);

  std::vector<std::unique_ptr<World>> worlds_;
  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable begin_, done_;
  Job job_;
  long round_ = 0;  ///< which job this is
  int busy_ = 0;    ///< workers that are still at it
  bool stopping_ = false;
  std::atomic<int> next_ = 0;
  std::exception_ptr error_;
  int error_of_ = 0;  ///< which candidate's
};

}  // namespace sim
