#pragma once
#include <cstdint>
#include <string>
#include <vector>

/// The status of a run as lines of text.
namespace launch {

/// One component. Ages and jitter in µs; 0 or less: not measured.
struct Row {
  std::string name, state;
  long pid = 0;
  double rate_Hz = 0;
  double age_p50_us = 0, age_p99_us = 0, jitter_p99_us = 0;
  std::uint64_t overruns = 0, missed = 0;
  long restarts = -1;       ///< negative: not known, as in erp ps
  double cpu_percent = -1;  ///< of one core; negative: not measured
  std::string note;         ///< the last note of its heartbeat
};

struct Status {
  std::string graph, device, time, stage;
  double elapsed_s = 0;     ///< real time since the start
  double device_s = -1;     ///< device time; negative: no clock message received
  double remaining_s = -1;  ///< remaining real time; negative: no limit
  std::vector<Row> rows;
};

std::string microseconds(double duration_us);  ///< "85 µs", "1.3 ms", "-" when not measured
std::vector<std::string> render_rows(const std::vector<Row>& rows);
std::vector<std::string> render(const Status& status);

}  // namespace launch
