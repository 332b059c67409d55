#include "launch/erp/run/process.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

namespace launch {
namespace {

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

/// Owns a file descriptor; −1: none.
struct Descriptor {
  int number = -1;
  ~Descriptor() { close(); }
  void close() {
    if (number >= 0) ::close(std::exchange(number, -1));
  }
};

/// Runs in the child process and executes the program. Makes only async-signal-safe calls before
/// exec, because the launcher has DDS threads.
[[noreturn]] void exec_program(char* const* argv, char* const* environment, pid_t parent,
                               int death_signal, int input, int log, int error_pipe) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, death_signal);
  if (getppid() != parent) _exit(1);  // the launcher died before the line above
  sigset_t no_signals;
  sigemptyset(&no_signals);
  sigprocmask(SIG_SETMASK, &no_signals, nullptr);
  for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGCHLD}) signal(number, SIG_DFL);
  dup2(input, STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  close_range(3, ~0u, CLOSE_RANGE_CLOEXEC);  // also sockets that a library opened without O_CLOEXEC
  execvpe(argv[0], argv, environment);
  const int error = errno;
  [[maybe_unused]] const auto written = write(error_pipe, &error, sizeof error);
  _exit(127);
}

}  // namespace

std::string to_string(const Ending& ending) {
  if (!ending.signal) return "exit code " + std::to_string(ending.code);
  return "killed by signal " + std::to_string(ending.signal) + " (" + strsignal(ending.signal) +
         ")";
}

/// Pointers into `added` and into this process's environment.
static std::vector<char*> environment_with(const std::vector<std::string>& added) {
  std::vector<char*> entries;
  for (const auto& entry : added) entries.push_back(const_cast<char*>(entry.c_str()));
  const auto is_replaced = [&](std::string_view inherited) {
    return std::ranges::any_of(added, [&](const std::string& entry) {
      return inherited.starts_with(entry.substr(0, entry.find('=') + 1));
    });
  };
  for (char** entry = environ; *entry; ++entry)
    if (!is_replaced(*entry)) entries.push_back(*entry);
  entries.push_back(nullptr);
  return entries;
}

Process::Process(const std::vector<std::string>& argv, const std::string& log_file,
                 int death_signal, const std::vector<std::string>& environment) {
  const Descriptor input{open("/dev/null", O_RDONLY | O_CLOEXEC)};
  const Descriptor log{open(log_file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644)};
  if (log.number < 0) fail(errno, log_file);
  int pipe_ends[2];
  if (pipe2(pipe_ends, O_CLOEXEC) != 0) fail(errno, "pipe");
  Descriptor error_reader{pipe_ends[0]}, error_writer{pipe_ends[1]};

  std::vector<char*> arguments;
  for (const auto& argument : argv) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const std::vector<char*> variables = environment_with(environment);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ < 0) fail(errno, "fork");
  if (pid_ == 0)
    exec_program(arguments.data(), variables.data(), parent, death_signal, input.number, log.number,
                 error_writer.number);
  setpgid(pid_, pid_);  // both parent and child set it: neither has to wait for the other
  error_writer.close();

  // exec closes the pipe; an error number in the pipe means that exec failed.
  int error = 0;
  if (read(error_reader.number, &error, sizeof error) == sizeof error) {
    waitpid(pid_, nullptr, 0);
    fail(error, argv[0]);
  }
  descriptor_ = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));
  if (descriptor_ < 0) {
    error = errno;
    send(SIGKILL);
    collect(0);
    fail(error, "pidfd_open");
  }
}

Process::Process(Process&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      ending_(std::exchange(other.ending_, std::nullopt)) {}

Process& Process::operator=(Process&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(ending_, other.ending_);
  return *this;
}

Process::~Process() {
  if (pid_ > 0 && !ending_) {
    send(SIGKILL);
    collect(0);
  }
  if (descriptor_ >= 0) close(descriptor_);
}

void Process::send(int signal) const {
  if (pid_ > 0 && !ending_) kill(-pid_, signal);
}

std::optional<Ending> Process::poll() {
  if (pid_ > 0 && !ending_) collect(WNOHANG);
  return ending_;
}

void Process::collect(int wait_options) {
  // WNOWAIT does not reap the process: its pid stays reserved while the group receives SIGKILL.
  siginfo_t info{};
  if (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT | wait_options) != 0) {
    ending_ = Ending{-1, 0};  // already reaped elsewhere
    return;
  }
  if (info.si_pid == 0) return;
  kill(-pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  const bool exited = info.si_code == CLD_EXITED;
  ending_ = exited ? Ending{info.si_status, 0} : Ending{0, info.si_status};
}

}  // namespace launch
