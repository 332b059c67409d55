#include "sim/model/actuator/sampling.hpp"

#include <catch2/catch.hpp>
#include <vector>

namespace {

/// What a sensor says at each millisecond when it is shown the time in ms.
std::vector<int> said(double rate_Hz, double latency_s, int steps = 30) {
  sim::Sampled<int> sampled({rate_Hz, latency_s}, 0.001);
  std::vector<int> values;
  double time_s = 0;  // added up, as a world does
  for (int k = 0; k <= steps; ++k, time_s += 0.001) {
    sampled.offer(time_s, [k] { return k; });
    values.push_back(sampled.said(time_s).value);
  }
  return values;
}

}  // namespace

TEST_CASE("a sensor without rate and latency says what is") {
  CHECK_FALSE(sim::Sampled<int>({}, 0.001).timed());
  for (int k = 0; k <= 30; ++k) REQUIRE(said(0, 0)[std::size_t(k)] == k);
}

TEST_CASE("between two looks a sensor says the same") {
  const auto values = said(100, 0);
  for (int k = 0; k <= 30; ++k) REQUIRE(values[std::size_t(k)] == k / 10 * 10);
}

TEST_CASE("what a sensor says is as old as its latency, and at first its first look") {
  const auto values = said(0, 0.007);
  for (int k = 0; k <= 30; ++k) REQUIRE(values[std::size_t(k)] == std::max(0, k - 7));
}

TEST_CASE(
    "after a time that has been before a sensor begins anew, and for hours it keeps its beat") {
  sim::Sampled<int> sampled({100, 0.002}, 0.001);
  for (int k = 0; k < 50; ++k) sampled.offer(0.001 * k, [k] { return k; });
  sampled.offer(0.003, [] { return -1; });
  CHECK(sampled.said(0.003).value == -1);
  double time_s = 7200, looks = 0;  // added up without compensation
  for (int k = 0; k < 100000; ++k, time_s += 0.001)
    sampled.offer(time_s, [&] { return int(++looks); });
  CHECK(looks == 10000);
}

TEST_CASE("rate and latency together: the newest look that has arrived") {
  const auto values = said(200, 0.012, 200);
  for (int k = 12; k <= 200; ++k) REQUIRE(values[std::size_t(k)] == (k - 12) / 5 * 5);
}
