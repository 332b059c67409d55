#pragma once
#include <chrono>
#include <iosfwd>
#include <string>

namespace launch {

/// Progress bar with remaining time, on one line of a terminal. Prints nothing if the stream is not
/// a terminal.
class Progress {
 public:
  explicit Progress(std::ostream& out);
  ~Progress();
  /// `fraction`: completed part of the work, 0 … 1.
  void show(const std::string& what, double fraction);

 private:
  std::ostream& out_;
  bool is_terminal_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), last_shown_{};
};

}  // namespace launch
