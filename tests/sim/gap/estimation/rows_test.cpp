#include <catch2/catch.hpp>
#include <cmath>

#include "sim/gap/estimation/defective_rows.hpp"
#include "sim/gap/estimation/limits.hpp"
#include "sim/gap/estimation/row_timing.hpp"
#include "tests/sim/gap/diagnosis/blind_recording.hpp"

using namespace sim::estimation;
using sim::residuals::Episode;
using sim::residuals::Signal;

namespace {

std::vector<Episode> recordings() {
  return blind_recording::episodes(blind_recording::nothing_hidden(), 5, 2);
}

/// Moves the samples to earlier rows.
void shift_earlier(Signal& signal, std::size_t rows) {
  for (std::size_t k = 0; k + rows < signal.size(); ++k) signal[k] = signal[k + rows];
}

std::size_t missing(const Signal& signal) {
  return std::size_t(std::ranges::count_if(signal, [](double x) { return std::isnan(x); }));
}

}  // namespace

TEST_CASE("a recording whose voltage is held until its row has no lag") {
  CHECK(row_timing(recordings()).rows == 0);
}

TEST_CASE("a voltage that is held from its row is detected and shifted with mode and reference") {
  auto all = recordings();
  const auto original = all;
  for (Episode& e : all)
    for (auto& s : e.actuators)
      shift_earlier(s.voltage_V, 1), shift_earlier(s.reference, 1), shift_earlier(s.mode, 1);
  const RowTiming timing = row_timing(all);
  CHECK(timing.from_row());
  std::vector<std::string> remarks;
  compensate(timing, all, remarks);
  CHECK(remarks.size() == 1);
  CHECK(all[0].actuators[0].voltage_V[100] == original[0].actuators[0].voltage_V[100]);
  CHECK(all[0].actuators[0].reference[100] == original[0].actuators[0].reference[100]);
  CHECK(all[0].voltage_delay_s == 0);
}

TEST_CASE("a voltage shifted by four rows is detected as a delay of 8 ms") {
  auto all = recordings();
  for (Episode& e : all)
    for (auto& s : e.actuators) shift_earlier(s.voltage_V, 4);
  const RowTiming timing = row_timing(all);
  CHECK(timing.delay_s() == Approx(0.008));
  std::vector<std::string> remarks;
  compensate(timing, all, remarks);
  CHECK(all[0].voltage_delay_s == Approx(0.008));
}

TEST_CASE("a driver delay of 1.3 ms at one motor is not reported as a lag of rows") {
  sim::blind::Case delayed = blind_recording::nothing_hidden();
  delayed.hidden_effects.channels[0].driver_delay_s = 0.0013;
  CHECK(row_timing(blind_recording::episodes(delayed, 5, 2)).rows == 0);
}

TEST_CASE("a lag of three rows at one actuator is not reported as a lag of rows") {
  auto all = recordings();
  for (Episode& e : all) shift_earlier(e.actuators[0].voltage_V, 3);
  CHECK(row_timing(all).rows == 0);
}

TEST_CASE("voltage and current at a current limit become NaN, tension does not") {
  auto all = recordings();
  auto& s = all[0].actuators[0];
  for (std::size_t k = 1000; k < 1050; ++k) s.current_A[k] = 3.99, s.voltage_V[k] = 11.5;
  const std::size_t before = missing(s.voltage_V);
  std::vector<std::string> remarks;
  apply_limits(blind_recording::hinge_rig(), all, remarks);
  REQUIRE(remarks.size() == 1);
  CHECK(remarks[0].find("current limit of 4 A in 50 rows") != std::string::npos);
  CHECK(missing(s.voltage_V) - before == 52);
  CHECK(std::isnan(s.current_A[1020]));
  CHECK_FALSE(std::isnan(s.tension_N[1020]));
}

TEST_CASE("a voltage above the supply is clipped, a tension at the end of its range becomes NaN") {
  auto all = recordings();
  auto& s = all[0].actuators[1];
  s.voltage_V[500] = -20, s.tension_N[600] = 250;
  std::vector<std::string> remarks;
  apply_limits(blind_recording::hinge_rig(), all, remarks);
  CHECK(s.voltage_V[500] == -12);
  CHECK(std::isnan(s.tension_N[600]));
  CHECK(remarks.size() == 2);
}

namespace {

/// Repeats the previous row in `burst` successive rows after every `each` rows.
void repeat_rows(Episode& e, std::size_t each, std::size_t burst) {
  const auto repeat = [&](Signal& signal) {
    for (std::size_t k = each; k < signal.size(); ++k)
      if (k % each < burst) signal[k] = signal[k - 1];
  };
  for (auto& s : e.actuators)
    repeat(s.voltage_V), repeat(s.current_A), repeat(s.shaft_rad), repeat(s.tension_N);
  for (auto& j : e.joints) repeat(j.angle_rad);
}

/// Samples every row at a random time up to `max_delay_s` after its time stamp.
void delay_rows(Episode& e, double max_delay_s) {
  std::vector<double> delay_s(e.rows);
  std::uint32_t state = 1;
  for (double& t : delay_s) {
    state = state * 1664525u + 1013904223u;
    t = max_delay_s * double(state >> 8) / double(1 << 24);
  }
  const auto sample = [&](Signal& signal) {
    const Signal exact = signal;
    for (std::size_t k = 0; k + 1 < exact.size(); ++k)
      signal[k] += (exact[k + 1] - exact[k]) * delay_s[k] / e.period_s;
  };
  for (auto& s : e.actuators) sample(s.current_A), sample(s.shaft_rad), sample(s.tension_N);
  for (auto& j : e.joints) sample(j.angle_rad);
}

}  // namespace

TEST_CASE(
    "an intact recording has no repeated rows and no jitter, and constant rows are not lost") {
  auto all = recordings();
  CHECK(repeated_rows(all).fraction == 0);
  CHECK(row_jitter_s(all) == 0);
  Episode at_rest = all[0];
  repeat_rows(at_rest, 1, 1);  // every row equals the first
  CHECK(repeated_rows(std::span(&at_rest, 1)).fraction == 0);
}

TEST_CASE("four lost reports of forty are reported; angles are interpolated, voltages become NaN") {
  auto all = recordings();
  const auto truth = all;
  for (Episode& e : all) repeat_rows(e, 40, 4);
  CHECK(repeated_rows(all).fraction == Approx(0.1).epsilon(0.1));
  std::vector<std::string> remarks;
  repair_defective_rows(all, remarks);
  REQUIRE(remarks.size() == 1);
  CHECK(remarks[0].find("reports were lost") != std::string::npos);
  CHECK(all[0].repeated_fraction == Approx(0.1).epsilon(0.1));
  const std::size_t repeated_row = 1001;  // 1000 … 1003
  const auto &repaired = all[0].actuators[0], &exact = truth[0].actuators[0];
  CHECK(std::isnan(repaired.voltage_V[repeated_row]));
  CHECK(std::isnan(repaired.current_A[repeated_row]));
  CHECK(repaired.shaft_rad[repeated_row] == Approx(exact.shaft_rad[repeated_row]).margin(0.02));
  CHECK(repaired.shaft_rad[repeated_row] != repaired.shaft_rad[repeated_row - 1]);
}

TEST_CASE(
    "delays of rows up to 1.5 ms are identified as jitter in all sensors, but not in a single "
    "sensor") {
  auto all = recordings();
  for (Episode& e : all) delay_rows(e, 0.0015);
  CHECK(row_jitter_s(all) == Approx(0.0015).epsilon(0.15));
  auto single_sensor = recordings();
  for (std::size_t e = 0; e < single_sensor.size(); ++e)
    single_sensor[e].actuators[0].shaft_rad = all[e].actuators[0].shaft_rad;
  CHECK(row_jitter_s(single_sensor) == 0);
}
