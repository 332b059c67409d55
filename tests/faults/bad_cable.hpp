#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "components/node/clock.hpp"
#include "hal/can/bus.hpp"
#include "hal/can/load.hpp"

namespace faults {

/// Impairment of a cable: fractions of frames, and delays in ms.
struct Impairment {
  double lost = 0, doubled = 0, delay_ms = 0, jitter_ms = 0;
};

/// A cable of 1 Mbit/s between the gateway's bus and the ECUs' bus: one frame at a time, the lower
/// identifier first, worst-case stuffing, with impairments.
class BadCable {
 public:
  BadCable(const std::string& host, const std::string& ecus)
      : ends_{erp::open_bus(host), erp::open_bus(ecus)}, thread_([this] { carry(); }) {}
  ~BadCable() {
    done_ = true;
    thread_.join();
  }

  void impair(const Impairment& impairment) {
    const std::lock_guard lock(guard_);
    impairment_ = impairment;
    gap_ns_ = 0;
  }
  int lost() const { return lost_; }
  int doubled() const { return doubled_; }
  int carried() const { return carried_; }
  /// Longest delay of the cable by this machine since the last `impair`.
  double stall_ms() const { return 1e-6 * double(gap_ns_); }

 private:
  struct Frame {
    erp::CanFrame frame;
    std::size_t to;
    std::int64_t at_ns = 0;  ///< arrival time
  };

  void carry() {
    for (auto last_ns = node::monotonic_ns(); !done_;) {
      const auto now_ns = node::monotonic_ns();
      gap_ns_ = std::max(gap_ns_.load(), now_ns - std::exchange(last_ns, now_ns));
      for (std::size_t end : {0u, 1u}) receive_frames(end);
      transmit(now_ns);
      deliver(now_ns);
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  }
  void receive_frames(std::size_t from) {
    std::array<erp::CanFrame, 64> frames;
    while (const auto n = ends_[from]->receive(frames, 0))
      for (const auto& frame : std::span(frames).first(n)) waiting_.push_back({frame, 1 - from});
  }
  /// Transmits the frames for which the bus had time, by priority.
  void transmit(std::int64_t now_ns) {
    static const auto frame_ns = std::int64_t(1e9 * erp::frame_time_s(8, 1e6));
    while (!waiting_.empty() && free_ns_ <= now_ns) {
      const auto next =
          std::ranges::min_element(waiting_, {}, [](const Frame& frame) { return frame.frame.id; });
      free_ns_ = std::max(free_ns_, now_ns - 1'000'000) + frame_ns;
      arrive(*next, free_ns_);
      waiting_.erase(next);
      ++carried_;
    }
  }
  void arrive(Frame frame, std::int64_t now_ns) {
    const std::lock_guard lock(guard_);
    std::uniform_real_distribution<double> fraction(0, 1);
    if (fraction(random_) < impairment_.lost) return void(++lost_);
    const int copies = fraction(random_) < impairment_.doubled ? 2 : 1;
    doubled_ += copies - 1;
    for (int k = 0; k < copies; ++k) {
      const double delay_ms =
          impairment_.delay_ms + impairment_.jitter_ms * (2 * fraction(random_) - 1);
      frame.at_ns = now_ns + std::int64_t(1e6 * delay_ms);
      in_transit_.push_back(frame);
    }
  }
  void deliver(std::int64_t now_ns) {
    std::ranges::stable_sort(in_transit_, {}, &Frame::at_ns);
    const auto first_later =
        std::ranges::find_if(in_transit_, [&](const Frame& frame) { return frame.at_ns > now_ns; });
    for (auto it = in_transit_.begin(); it != first_later; ++it)
      ends_[it->to]->send({&it->frame, 1});
    in_transit_.erase(in_transit_.begin(), first_later);
  }

  std::array<std::unique_ptr<erp::CanBus>, 2> ends_;
  std::mutex guard_;
  Impairment impairment_;
  std::mt19937 random_{1};
  std::vector<Frame> waiting_, in_transit_;
  std::int64_t free_ns_ = 0;
  std::atomic<int> lost_ = 0, doubled_ = 0, carried_ = 0;
  std::atomic<std::int64_t> gap_ns_ = 0;
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

}  // namespace faults
