#include "sim/world/internal_model.hpp"

#include <algorithm>
#include <utility>

namespace sim {

InternalModel::InternalModel(const erp::Robot& robot, const WorldOptions& options, int threads) {
  if (threads <= 0) threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  for (int k = 0; k < threads; ++k) worlds_.push_back(std::make_unique<World>(robot, options));
  try {
    for (auto& world : worlds_) workers_.emplace_back([this, &world] { work(*world); });
  } catch (...) {  // no further threads available
    stop();
    throw;
  }
}

InternalModel::~InternalModel() { stop(); }

void InternalModel::stop() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  begin_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void InternalModel::work(World& world) {
  for (long last_round = 0;;) {
    std::unique_lock lock(mutex_);
    begin_.wait(lock, [&] { return stopping_ || round_ > last_round; });
    if (stopping_) return;
    last_round = round_;
    const Job job = job_;
    lock.unlock();
    run_candidates(world, job);
    lock.lock();
    if (--busy_ == 0) done_.notify_all();
  }
}

void InternalModel::run_candidates(World& world, const Job& job) {
  for (int k = next_++; k < job.candidates; k = next_++) try {
      world.restore(*job.from);
      (*job.play)(world, k);
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      if (!error_ || k < error_candidate_) error_ = std::current_exception(), error_candidate_ = k;
    }
}

void InternalModel::each(const WorldState& from, int candidates,
                         const std::function<void(World&, int)>& play) {
  std::unique_lock lock(mutex_);
  job_ = {&from, &play, candidates};
  next_ = 0;
  busy_ = threads();
  ++round_;
  begin_.notify_all();
  done_.wait(lock, [this] { return busy_ == 0; });
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

std::vector<WorldState> InternalModel::ahead(const WorldState& from,
                                             std::span<const std::vector<double>> voltages_V,
                                             int steps, double dt_s) {
  std::vector<WorldState> ends(voltages_V.size());
  each(from, static_cast<int>(ends.size()), [&](World& world, int k) {
    const auto candidate = static_cast<std::size_t>(k);
    for (int step = 0; step < steps; ++step) world.step(voltages_V[candidate], dt_s);
    ends[candidate] = world.save();
  });
  return ends;
}

}  // namespace sim
