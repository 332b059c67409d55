#pragma once
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/system/command.hpp"

namespace tests {

using namespace std::chrono_literals;

/// Waits up to a minute until `condition` returns true. Returns false after a minute, so that a
/// test cannot hang.
template <class Condition>
bool wait_until(Condition&& condition) {
  for (int i = 0; i < 6000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(10ms);
  }
  return false;
}

/// `erp launch …` or another program of this repository as a background process. The destructor
/// ends it.
class Background {
 public:
  Background(const std::vector<std::string>& arguments, std::string output,
             const std::string& program = "erp")
      : output_(std::move(output)) {
    pid_ = fork();
    if (pid_ != 0) return;
    const int file = open(output_.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0644);
    dup2(file, 1), dup2(file, 2);
    if (chdir(ERP_SOURCE_DIR) != 0) _exit(126);
    const std::string path = std::string(ERP_BIN_DIR "/") + program;
    std::vector<char*> argv{const_cast<char*>(path.c_str())};
    for (const auto& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    _exit(127);
  }
  ~Background() {
    if (pid_ > 0) stop(SIGTERM);
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Waits up to a minute until the output contains `text`.
  bool wait_for_output(const std::string& text) const {
    return wait_until([&] { return content(output_).find(text) != std::string::npos; });
  }
  std::string output() const { return content(output_); }
  pid_t pid() const { return pid_; }

  /// Process id of the running child with this program name; 0 if there is none.
  pid_t child(const std::string& program) const {
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      std::ifstream stat(entry.path() / "stat");
      std::string line;
      if (!std::getline(stat, line)) continue;
      const auto open = line.find('('), close = line.rfind(')');
      std::istringstream rest(line.substr(close + 2));
      char state;
      pid_t parent;
      rest >> state >> parent;
      if (parent == pid_ && state != 'Z' &&
          line.substr(open + 1, close - open - 1) == program.substr(0, 15))
        return static_cast<pid_t>(std::stol(line));
    }
    return 0;
  }
  std::vector<pid_t> children() const {
    std::vector<pid_t> children;
    std::ifstream file("/proc/" + std::to_string(pid_) + "/task/" + std::to_string(pid_) +
                       "/children");
    for (pid_t child; file >> child;) children.push_back(child);
    return children;
  }
  /// Sends a signal and waits for the end. Returns the exit code, or 128 + signal if a signal ended
  /// the process.
  int stop(int signal = SIGINT) {
    kill(pid_, signal);
    return wait();
  }
  int wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  std::string output_;
  pid_t pid_ = 0;
};

}  // namespace tests
