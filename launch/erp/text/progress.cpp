#include "launch/erp/text/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>

namespace launch {

Progress::Progress(std::ostream& out)
    : out_(out), is_terminal_(&out == &std::cerr && isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (is_terminal_) out_ << "\r\033[K" << std::flush;
}

void Progress::show(const std::string& what, double fraction) {
  using namespace std::chrono;
  const auto now = steady_clock::now();
  if (!is_terminal_ || now - last_shown_ < milliseconds(100)) return;
  last_shown_ = now;
  constexpr int width = 30;              // columns of the bar
  constexpr double min_fraction = 0.02;  // below it, the remaining time is not estimated; chosen
  const int filled_columns = static_cast<int>(width * std::clamp(fraction, 0.0, 1.0));
  const double spent_s = duration<double>(now - start_).count();
  const std::string remaining =
      fraction > min_fraction ? fmt::format("{:.0f} s left", spent_s * (1 - fraction) / fraction)
                              : "";
  out_ << fmt::format("\r\033[K[{:=<{}}{:<{}}] {:3.0f} %  {}  {}", "", filled_columns, "",
                      width - filled_columns, 100 * fraction, what, remaining)
       << std::flush;
}

}  // namespace launch
