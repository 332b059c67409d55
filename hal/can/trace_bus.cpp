#include <sys/timerfd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <vector>

#include "hal/can/backends.hpp"
#include "hal/can/trace.hpp"

// A trace as a bus: the frames of ECUs are received at the recorded rate, from the first `receive`
// on; sent frames are discarded.
namespace erp::can {
namespace {

bool is_from_host(const CanFrame& frame) {
  const frame_function function = frame_function_of(&frame);
  return function == FRAME_COMMAND || function == FRAME_PARAMETER || function == FRAME_DISCOVER;
}

std::vector<TraceLine> read_trace(const std::string& name) {
  std::ifstream file(name);
  if (!file) throw std::runtime_error("cannot read it: " + std::string(std::strerror(errno)));
  std::vector<TraceLine> lines;
  for (std::string line; std::getline(file, line);)
    if (const auto line_of_ecu = parse_trace_line(line);
        line_of_ecu && !is_from_host(line_of_ecu->frame))
      lines.push_back(*line_of_ecu);
  if (lines.empty())
    throw std::runtime_error("contains no frame of an ECU; give a file of `candump -L`");
  const auto earlier = [](const TraceLine& a, const TraceLine& b) { return a.time_s < b.time_s; };
  std::ranges::stable_sort(lines, earlier);
  return lines;
}

class TraceBus final : public CanBus {
 public:
  explicit TraceBus(const std::string& file)
      : lines_(read_trace(file)), timer_(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK)) {
    if (timer_.get() < 0)
      throw std::runtime_error(std::string("no timer: ") + std::strerror(errno));
    arm({0, 0}, {0, step_ns});  // expires once, to wake the first `receive`
  }

  std::size_t send(std::span<const CanFrame> frames) override {
    counters_.sent += frames.size();
    return frames.size();
  }

  std::size_t receive(std::span<CanFrame> frames, double timeout_s) override {
    if (!wait_readable(timer_.get(), timeout_s)) return 0;
    advance_time();
    std::size_t filled = 0;
    while (filled < frames.size() && next_ < lines_.size() && is_due(lines_[next_]))
      frames[filled++] = frame_of(lines_[next_++]);
    counters_.received += filled;
    return filled;
  }

  int fd() const override { return timer_.get(); }
  BusCounters counters() const override { return counters_; }
  void record(FrameSink* sink) override { sink_ = sink; }

 private:
  static constexpr long step_ns = 500'000;  ///< resolution of the replay; chosen

  bool is_due(const TraceLine& line) const {
    return line.time_s - lines_.front().time_s <= 1e-9 * step_ns * static_cast<double>(steps_);
  }

  /// The timer reports the number of elapsed steps; no clock is read and no step is lost.
  void advance_time() {
    std::uint64_t steps = 0;
    if (::read(timer_.get(), &steps, sizeof steps) <= 0) return;
    if (!playing_) arm({0, step_ns}, {0, step_ns});
    else steps_ += steps;
    playing_ = true;
  }

  CanFrame frame_of(const TraceLine& line) {
    if (sink_) sink_->frame(line.frame, std::llround(line.time_s * 1e9), false);
    return line.frame;
  }

  void arm(timespec interval, timespec first) {
    const itimerspec schedule{interval, first};
    ::timerfd_settime(timer_.get(), 0, &schedule, nullptr);
  }

  std::vector<TraceLine> lines_;
  std::size_t next_ = 0;
  std::uint64_t steps_ = 0;  ///< since the first frame
  bool playing_ = false;
  Descriptor timer_;
  FrameSink* sink_ = nullptr;
  BusCounters counters_;
};

}  // namespace

std::unique_ptr<CanBus> open_trace(const std::string& file) {
  return std::make_unique<TraceBus>(file);
}

}  // namespace erp::can
