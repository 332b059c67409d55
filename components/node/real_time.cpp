#include "components/node/real_time.hpp"

#include <pthread.h>

namespace node {
namespace {

// Chosen: behind ECUs that are processes (hal/ecu), each with a processor to itself.
constexpr sched_param urgent{.sched_priority = 5};

}  // namespace

RealTime::RealTime(bool wanted) {
  pthread_getschedparam(pthread_self(), &policy_before_, &before_);
  on_ = wanted && pthread_setschedparam(pthread_self(), SCHED_FIFO, &urgent) == 0;
}

RealTime::~RealTime() {
  if (on_) pthread_setschedparam(pthread_self(), policy_before_, &before_);
}

bool may_run_in_real_time() { return RealTime(true).on(); }

}  // namespace node
