#pragma once
#include <algorithm>
#include <vector>

#include "hal/can/bus.hpp"

namespace can_test {

/// A bus that accepts a given number of frames; for conditions that a real bus does not produce on
/// demand.
struct NarrowBus : erp::CanBus {
  std::size_t room = 0, in_flight_frames = 0;
  std::vector<erp::CanFrame> sent_frames;
  erp::BusCounters bus_counters;
  int restarts = 0;

  std::size_t send(std::span<const erp::CanFrame> frames) override {
    const std::size_t count = std::min(room, frames.size());
    sent_frames.insert(sent_frames.end(), frames.begin(), frames.begin() + std::ptrdiff_t(count));
    room -= count;
    bus_counters.sent += count;
    return count;
  }
  std::size_t receive(std::span<erp::CanFrame>, double) override { return 0; }
  int fd() const override { return -1; }
  erp::BusCounters counters() const override { return bus_counters; }
  std::size_t in_flight() const override { return in_flight_frames; }
  void restart() override { ++restarts; }
  void record(erp::FrameSink*) override {}
};

}  // namespace can_test
