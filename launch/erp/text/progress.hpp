#pragma once
#include <chrono>
#include <iosfwd>
#include <string>

namespace launch {

/// How far long work is and how long it will take, on one line of a terminal; nothing where the
/// stream is none.
class Progress {
 public:
  explicit Progress(std::ostream& out);
  ~Progress();
  /// `share` of the work is done, 0 … 1.
  void tell(const std::string& what, double share);

 private:
  std::ostream& out_;
  bool terminal_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), told_{};
};

}  // namespace launch
