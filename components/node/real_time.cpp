#include "components/node/real_time.hpp"

#include <pthread.h>

namespace node {
namespace {

// Chosen: lower than the priority of ECU processes (hal/ecu), each of which has its own processor
// core.
constexpr sched_param real_time{.sched_priority = 5};

}  // namespace

RealTimePriority::RealTimePriority(bool enable) {
  pthread_getschedparam(pthread_self(), &policy_before_, &parameters_before_);
  on_ = enable && pthread_setschedparam(pthread_self(), SCHED_FIFO, &real_time) == 0;
}

RealTimePriority::~RealTimePriority() {
  if (on_) pthread_setschedparam(pthread_self(), policy_before_, &parameters_before_);
}

bool may_run_in_real_time() { return RealTimePriority(true).on(); }

}  // namespace node
