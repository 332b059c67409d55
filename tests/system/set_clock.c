/* Preloaded library: adds the shift in the file ERP_CLOCK_SHIFT, an int64 in ns, to the wall clock. The
   file is mapped, so a change applies to all processes at once, as when a person sets the clock. A wait
   until a wall time ends when the shifted clock reaches it, even if the shift changes meanwhile. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static const volatile int64_t* shift_ns;
static const int64_t second_ns = 1000000000, slice_ns = 5000000;

static int64_t to_ns(const struct timespec* time) {
  return (int64_t)time->tv_sec * second_ns + time->tv_nsec;
}

static struct timespec to_timespec(int64_t ns) {
  const struct timespec time = {(time_t)(ns / second_ns), (long)(ns % second_ns)};
  return time;
}

__attribute__((constructor)) static void map_shift(void) {
  const char* name = getenv("ERP_CLOCK_SHIFT");
  const int file = name ? open(name, O_RDONLY | O_CLOEXEC) : -1;
  if (file < 0) abort();
  shift_ns = mmap(NULL, sizeof *shift_ns, PROT_READ, MAP_SHARED, file, 0);
  close(file);
  if (shift_ns == MAP_FAILED) abort();
}

int clock_gettime(clockid_t clock, struct timespec* time) {
  static int (*real)(clockid_t, struct timespec*);
  if (!real) real = (int (*)(clockid_t, struct timespec*))dlsym(RTLD_NEXT, "clock_gettime");
  const int result = real(clock, time);
  if (result || clock != CLOCK_REALTIME || !shift_ns) return result;
  *time = to_timespec(to_ns(time) + *shift_ns);
  return 0;
}

int gettimeofday(struct timeval* restrict time, void* restrict zone) {
  (void)zone;
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  time->tv_sec = now.tv_sec;
  time->tv_usec = (suseconds_t)(now.tv_nsec / 1000);
  return 0;
}

time_t time(time_t* out) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  if (out) *out = now.tv_sec;
  return now.tv_sec;
}

typedef int timed_wait(pthread_cond_t*, pthread_mutex_t*, const struct timespec*);

/* Waits in slices. A time in this century is a wall time; others are of the monotonic clock. */
int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                           const struct timespec* until) {
  static timed_wait* real;
  if (!real) real = (timed_wait*)dlvsym(RTLD_NEXT, "pthread_cond_timedwait", "GLIBC_2.3.2");
  if (until->tv_sec < second_ns || !shift_ns) return real(condition, mutex, until);
  for (;;) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    const int64_t remaining_ns = to_ns(until) - to_ns(&now);
    if (remaining_ns <= 0) return ETIMEDOUT;
    const int64_t wait_ns = remaining_ns < slice_ns ? remaining_ns : slice_ns;
    const struct timespec slice_end = to_timespec(to_ns(&now) - *shift_ns + wait_ns);
    const int result = real(condition, mutex, &slice_end);
    if (result != ETIMEDOUT) return result;
  }
}
