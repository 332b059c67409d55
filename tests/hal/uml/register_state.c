/* Lets user-mode Linux run on processors with more register state than it supports.
 *
 * The guest kernel 6.1 stores 2696 bytes of a process's extended state, enough for AVX-512. The
 * host kernel restores only the complete state (11008 bytes with AMX; otherwise EFAULT), so that
 * every guest process would end with SIGSEGV. This file, loaded before the C library, completes the
 * restored state with the current state of the process. The guest itself does not use AMX.
 * Reference: Linux, arch/x86/kernel/fpu/regset.c, xstateregs_set. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <elf.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/uio.h>

typedef long (*Ptrace)(enum __ptrace_request request, ...);

static long set_extended_state(Ptrace real, pid_t process, void* kind, struct iovec* part) {
  /* Static: the guest kernel's stacks are small, and it has one thread. */
  static char state[1 << 16];
  struct iovec complete = {state, sizeof state};
  if (real(PTRACE_GETREGSET, process, kind, &complete) < 0) return -1;
  const size_t size = part->iov_len < complete.iov_len ? part->iov_len : complete.iov_len;
  memcpy(state, part->iov_base, size);
  return real(PTRACE_SETREGSET, process, kind, &complete);
}

long ptrace(enum __ptrace_request request, ...) {
  static Ptrace real;
  if (!real) real = (Ptrace)dlsym(RTLD_NEXT, "ptrace");
  va_list rest;
  va_start(rest, request);
  const pid_t process = va_arg(rest, pid_t);
  void* const address = va_arg(rest, void*);
  void* const data = va_arg(rest, void*);
  va_end(rest);
  return request == PTRACE_SETREGSET && address == (void*)NT_X86_XSTATE
             ? set_extended_state(real, process, address, data)
             : real(request, process, address, data);
}
