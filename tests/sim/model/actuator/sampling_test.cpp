#include "sim/model/actuator/sampling.hpp"

#include <catch2/catch.hpp>
#include <vector>

namespace {

/// Readings at each millisecond of a sensor that measures the time in ms.
std::vector<int> readings(double rate_Hz, double latency_s, int steps = 30) {
  sim::Sampled<int> sampled({rate_Hz, latency_s}, 0.001);
  std::vector<int> values;
  double time_s = 0;  // summed up as in the simulator
  for (int k = 0; k <= steps; ++k, time_s += 0.001) {
    sampled.offer(time_s, [k] { return k; });
    values.push_back(sampled.latest(time_s).value);
  }
  return values;
}

}  // namespace

TEST_CASE("a sensor without rate and latency reads the current value") {
  CHECK_FALSE(sim::Sampled<int>({}, 0.001).timed());
  for (int k = 0; k <= 30; ++k) REQUIRE(readings(0, 0)[std::size_t(k)] == k);
}

TEST_CASE("between two samples the reading is constant") {
  const auto values = readings(100, 0);
  for (int k = 0; k <= 30; ++k) REQUIRE(values[std::size_t(k)] == k / 10 * 10);
}

TEST_CASE("a reading is delayed by the latency, and before that it is the first sample") {
  const auto values = readings(0, 0.007);
  for (int k = 0; k <= 30; ++k) REQUIRE(values[std::size_t(k)] == std::max(0, k - 7));
}

TEST_CASE("a step back in time resets a sensor, and the sampling rate is exact over hours") {
  sim::Sampled<int> sampled({100, 0.002}, 0.001);
  for (int k = 0; k < 50; ++k) sampled.offer(0.001 * k, [k] { return k; });
  sampled.offer(0.003, [] { return -1; });
  CHECK(sampled.latest(0.003).value == -1);
  double time_s = 7200, samples = 0;  // summed up without compensation
  for (int k = 0; k < 100000; ++k, time_s += 0.001)
    sampled.offer(time_s, [&] { return int(++samples); });
  CHECK(samples == 10000);
}

TEST_CASE("with rate and latency the reading is the latest sample that has arrived") {
  const auto values = readings(200, 0.012, 200);
  for (int k = 12; k <= 200; ++k) REQUIRE(values[std::size_t(k)] == (k - 12) / 5 * 5);
}
