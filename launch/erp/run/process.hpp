#pragma once
#include <sys/types.h>

#include <csignal>
#include <optional>
#include <string>
#include <vector>

/// One child process. Linux: fork, exec, pidfd.
namespace launch {

/// The end of a process: by its exit code, or by a signal (`signal` ≠ 0).
struct Ending {
  int code = 0;
  int signal = 0;
  bool clean() const { return code == 0 && signal == 0; }
};

/// "exit code 1", "killed by signal 9 (Killed)".
std::string to_string(const Ending& ending);

/// Owns a running program in its own process group.
///
/// The program receives `death_signal` when the launcher dies (PR_SET_PDEATHSIG), inherits no
/// descriptor except its log, has /dev/null as stdin, and has no signal blocked. When it ends, the
/// remaining processes of its group are killed. Create it on a thread that exists as long as the
/// launcher, because the kernel sends the death signal when that thread ends.
class Process {
 public:
  /// Appends stdout and stderr to `log_file`. Throws std::system_error when the log cannot be
  /// opened or the program cannot be executed.
  /// `environment`: `NAME=value`, in addition to the launcher's environment or in place of entries
  /// of it.
  Process(const std::vector<std::string>& argv, const std::string& log_file,
          int death_signal = SIGKILL, const std::vector<std::string>& environment = {});
  ~Process();  ///< kills the group if it still runs, and reaps the program
  Process(Process&& other) noexcept;
  Process& operator=(Process&& other) noexcept;

  pid_t pid() const { return pid_; }
  int descriptor() const { return descriptor_; }  ///< a pidfd: readable once the program has ended
  void send(int signal) const;  ///< to the whole group; no effect after the program has ended
  /// Reaps the program if it has ended and returns its end; empty while it runs.
  std::optional<Ending> poll();

 private:
  void collect(int wait_options);

  pid_t pid_ = -1;
  int descriptor_ = -1;
  std::optional<Ending> ending_;
};

}  // namespace launch
