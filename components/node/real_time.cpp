#include "components/node/real_time.hpp"

#include <pthread.h>

namespace node {
namespace {

// Chosen: lower than ECUs that are processes (hal/ecu), each with a processor to itself.
constexpr sched_param real_time{.sched_priority = 5};

}  // namespace

RealTimePriority::RealTimePriority(bool enable) {
  pthread_getschedparam(pthread_self(), &policy_before_, &before_);
  on_ = enable && pthread_setschedparam(pthread_self(), SCHED_FIFO, &real_time) == 0;
}

RealTimePriority::~RealTimePriority() {
  if (on_) pthread_setschedparam(pthread_self(), policy_before_, &before_);
}

bool may_run_in_real_time() { return RealTimePriority(true).on(); }

}  // namespace node
