#include "launch/erp/run/processor_share.hpp"

#include <unistd.h>

#include <fstream>
#include <optional>
#include <sstream>
#include <string>

namespace launch {
namespace {

constexpr std::int64_t min_interval_ns =
    500'000'000;  // chosen: the counters have a resolution of 10 ms

/// User and system time: fields 14 and 15 of proc(5) stat, counted after the ")" of the name.
std::optional<double> busy_s(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  if (!std::getline(file, text)) return std::nullopt;
  std::istringstream fields(text.substr(text.rfind(')') + 1));
  std::string skipped;
  for (int i = 3; i < 14; ++i) fields >> skipped;
  double user = 0, system = 0;
  if (!(fields >> user >> system)) return std::nullopt;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

}  // namespace

double ProcessorShare::measure(pid_t pid, std::int64_t now_ns) {
  if (pid == pid_ && now_ns - last_ns_ < min_interval_ns) return percent_;
  const auto busy = busy_s(pid);
  if (!busy) return pid_ = 0, percent_ = -1;
  percent_ = pid == pid_
                 ? 100 * (*busy - last_busy_s_) / (1e-9 * static_cast<double>(now_ns - last_ns_))
                 : -1;
  pid_ = pid, last_ns_ = now_ns, last_busy_s_ = *busy;
  return percent_;
}

}  // namespace launch
