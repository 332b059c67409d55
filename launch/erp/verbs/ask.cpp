#include "launch/erp/verbs/ask.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <system_error>

#include "components/node/clock.hpp"

namespace launch {
namespace {

constexpr std::int64_t patience_ns = 10'000'000'000;  // chosen

/// Starts a program whose stderr is the pipe's end `complaints`.
pid_t spawn(std::vector<std::string>& argv, int complaints) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, complaints, STDERR_FILENO);
  std::vector<char*> words;
  for (std::string& word : argv) words.push_back(word.data());
  words.push_back(nullptr);
  pid_t pid = -1;
  const int fault = posix_spawn(&pid, words[0], &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (fault != 0) throw std::system_error(fault, std::generic_category(), argv[0]);
  return pid;
}

/// Reads until the other side closes; false when it does not in time.
bool read_all(int descriptor, std::string& text) {
  const auto end_ns = node::monotonic_ns() + patience_ns;
  std::array<char, 4096> buffer{};
  for (;;) {
    const auto left_ms = (end_ns - node::monotonic_ns()) / 1'000'000;
    pollfd waiting{descriptor, POLLIN, 0};
    if (left_ms <= 0 || poll(&waiting, 1, static_cast<int>(left_ms)) == 0) return false;
    const ssize_t n = read(descriptor, buffer.data(), buffer.size());
    if (n <= 0) return true;
    text.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

}  // namespace

std::string ask_to_check(std::vector<std::string> argv) {
  argv.push_back("--check");
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "pipe");
  std::string complaints;
  int status = 0;
  bool answered = false;
  try {
    const pid_t pid = spawn(argv, ends[1]);
    close(ends[1]);
    answered = read_all(ends[0], complaints);
    if (!answered) kill(pid, SIGKILL);
    waitpid(pid, &status, 0);
    close(ends[0]);
  } catch (...) {
    close(ends[0]), close(ends[1]);
    throw;
  }
  if (!answered) return argv[0] + " gave no answer to --check; run it by hand";
  if (status == 0) return "";
  if (!complaints.empty()) return complaints;
  return argv[0] + " --check failed without a word; run it by hand";
}

}  // namespace launch
