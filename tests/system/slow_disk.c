/* Preloaded library: delays the third chunk that the logger of a graph writes by ERP_STALL_MS. While
 * the file ERP_FULL_FILE exists, the disk is full for the logger: every write fails. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

enum { chunk_bytes = 20000, slow_chunk = 3 }; /* smaller writes are not chunks */

static void stall_once(size_t bytes) {
  static int chunks;
  if (bytes < chunk_bytes || strcmp(program_invocation_short_name, "logger") != 0) return;
  if (++chunks != slow_chunk) return;
  const char* text = getenv("ERP_STALL_MS");
  const long stall_ms = text ? strtol(text, NULL, 10) : 0;
  if (stall_ms == 0) return;
  fprintf(stderr, "the disk stalls for %ld ms\n", stall_ms);
  const struct timespec stall = {stall_ms / 1000, stall_ms % 1000 * 1000000};
  nanosleep(&stall, NULL);
}

static int is_full(void) {
  const char* file = getenv("ERP_FULL_FILE");
  if (!file || strcmp(program_invocation_short_name, "logger") != 0 || access(file, F_OK) != 0)
    return 0;
  errno = ENOSPC;
  return 1;
}

ssize_t write(int file, const void* data, size_t bytes) {
  ssize_t (*const real)(int, const void*, size_t) = dlsym(RTLD_NEXT, "write");
  if (is_full()) return -1;
  stall_once(bytes);
  return real(file, data, bytes);
}

ssize_t writev(int file, const struct iovec* parts, int count) {
  ssize_t (*const real)(int, const struct iovec*, int) = dlsym(RTLD_NEXT, "writev");
  size_t bytes = 0;
  if (is_full()) return -1;
  for (int i = 0; i < count; ++i) bytes += parts[i].iov_len;
  stall_once(bytes);
  return real(file, parts, count);
}
