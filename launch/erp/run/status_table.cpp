#include "launch/erp/run/status_table.hpp"

#include "launch/erp/text/columns.hpp"
#include "launch/erp/text/duration.hpp"

namespace launch {
namespace {

std::string rate(double rate_Hz) { return rate_Hz > 0 ? decimal("%.0f Hz", rate_Hz) : "-"; }

}  // namespace

std::string microseconds(double duration_us) {
  if (duration_us <= 0) return "-";
  if (duration_us < 1000) return decimal("%.0f µs", duration_us);
  if (duration_us < 1e6) return decimal("%.1f ms", duration_us * 1e-3);
  return decimal("%.1f s", duration_us * 1e-6);
}

std::vector<std::string> render_rows(const std::vector<Row>& rows) {
  // the most important columns are on the left: a narrow terminal cuts off the right
  std::vector<std::vector<std::string>> cells{{"component", "state", "pid", "rate", "age p50",
                                               "p99", "cpu", "restarts", "missed", "overruns",
                                               "jitter p99", "note"}};
  for (const auto& row : rows)
    cells.push_back({row.name, row.state, row.pid > 0 ? std::to_string(row.pid) : "-",
                     rate(row.rate_Hz), microseconds(row.age_p50_us), microseconds(row.age_p99_us),
                     row.cpu_percent < 0 ? "-" : decimal("%.0f %%", row.cpu_percent),
                     row.restarts < 0 ? "-" : std::to_string(row.restarts),
                     std::to_string(row.missed), std::to_string(row.overruns),
                     microseconds(row.jitter_p99_us), row.note});
  return align(cells, {false, false, true, true, true, true, true, true, true, true, true, false});
}

std::vector<std::string> render(const Status& status) {
  std::string head = status.graph + "  " + status.stage + "  device " + status.device + ", " +
                     status.time + "  " + to_text_s(status.elapsed_s);
  if (status.device_s >= 0) head += ", device at " + to_text_s(status.device_s);
  if (status.remaining_s >= 0) head += ", " + to_text_s(status.remaining_s) + " left";
  std::vector<std::string> lines{head};
  for (auto& line : render_rows(status.rows)) lines.push_back(std::move(line));
  return lines;
}

}  // namespace launch
