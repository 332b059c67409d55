#include "launch/erp/verbs/component_check.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <iostream>
#include <stdexcept>
#include <system_error>

#include "components/node/clock.hpp"

namespace launch {
namespace {

constexpr std::int64_t component_timeout_ns = 10'000'000'000;  // chosen

/// Starts a program. Its `descriptor` (stdout or stderr) becomes the write end `pipe_end` of a
/// pipe.
pid_t spawn(std::vector<std::string>& argv, int descriptor, int pipe_end) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, pipe_end, descriptor);
  std::vector<char*> arguments;
  for (std::string& argument : argv) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::system_error(error, std::generic_category(), argv[0]);
  return pid;
}

/// Reads until the other side closes the pipe. Returns false at the timeout.
bool read_all(int descriptor, std::string& text) {
  const auto end_ns = node::monotonic_ns() + component_timeout_ns;
  std::array<char, 4096> buffer{};
  for (;;) {
    const auto remaining_ms = (end_ns - node::monotonic_ns()) / 1'000'000;
    pollfd polled{descriptor, POLLIN, 0};
    if (remaining_ms <= 0 || poll(&polled, 1, static_cast<int>(remaining_ms)) == 0) return false;
    const ssize_t n = read(descriptor, buffer.data(), buffer.size());
    if (n <= 0) return true;
    text.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

struct Output {
  bool is_complete = false;
  int status = 0;
  std::string text;
};

/// Runs a program and reads its output on `descriptor`; kills it at the timeout.
Output run_program(std::vector<std::string>& argv, int descriptor) {
  std::array<int, 2> pipe_ends{};
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "pipe");
  Output output;
  try {
    const pid_t pid = spawn(argv, descriptor, pipe_ends[1]);
    close(pipe_ends[1]);
    output.is_complete = read_all(pipe_ends[0], output.text);
    if (!output.is_complete) kill(pid, SIGKILL);
    waitpid(pid, &output.status, 0);
    close(pipe_ends[0]);
  } catch (...) {
    close(pipe_ends[0]), close(pipe_ends[1]);
    throw;
  }
  return output;
}

}  // namespace

std::string check_component(std::vector<std::string> argv) {
  argv.push_back("--check");
  const Output output = run_program(argv, STDERR_FILENO);
  if (!output.is_complete)
    return argv[0] + ": --check did not finish within 10 s; run it by hand with --check";
  if (output.status == 0) {
    std::cerr << output.text;  // warnings
    return "";
  }
  if (!output.text.empty()) return output.text;
  return argv[0] + ": --check failed without a message; run it by hand with --check";
}

std::string describe_component(const std::string& program) {
  std::vector<std::string> argv{program, "--describe"};
  const Output output = run_program(argv, STDOUT_FILENO);
  if (output.is_complete && output.status == 0) return output.text;
  throw std::invalid_argument(program +
                              ": --describe failed; name a component, a program of node::run");
}

}  // namespace launch
