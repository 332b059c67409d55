#pragma once
#include <algorithm>
#include <vector>

#include "hal/can/bus.hpp"

namespace can_test {

/// A bus that accepts a given number of frames; for conditions that a real bus does not produce on demand.
struct NarrowBus : erp::CanBus {
  std::size_t room = 0, flying = 0;
  std::vector<erp::CanFrame> taken;
  erp::BusCounters counted;
  int restarts = 0;

  std::size_t send(std::span<const erp::CanFrame> frames) override {
    const std::size_t count = std::min(room, frames.size());
    taken.insert(taken.end(), frames.begin(), frames.begin() + std::ptrdiff_t(count));
    room -= count;
    counted.sent += count;
    return count;
  }
  std::size_t receive(std::span<erp::CanFrame>, double) override { return 0; }
  int fd() const override { return -1; }
  erp::BusCounters counters() const override { return counted; }
  std::size_t in_flight() const override { return flying; }
  void restart() override { ++restarts; }
  void record(erp::FrameSink*) override {}
};

}  // namespace can_test
