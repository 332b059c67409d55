#include "launch/erp/text/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>

namespace launch {

Progress::Progress(std::ostream& out)
    : out_(out), terminal_(&out == &std::cerr && isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (terminal_) out_ << "\r\033[K" << std::flush;
}

void Progress::show(const std::string& what, double share) {
  using namespace std::chrono;
  const auto now = steady_clock::now();
  if (!terminal_ || now - shown_ < milliseconds(100)) return;
  shown_ = now;
  constexpr int width = 30;
  const int done = static_cast<int>(width * std::clamp(share, 0.0, 1.0));
  const double spent_s = duration<double>(now - start_).count();
  const std::string remaining =
      share > 0.02 ? fmt::format("{:.0f} s left", spent_s * (1 - share) / share) : "";
  out_ << fmt::format("\r\033[K[{:=<{}}{:<{}}] {:3.0f} %  {}  {}", "", done, "", width - done,
                      100 * share, what, remaining)
       << std::flush;
}

}  // namespace launch
