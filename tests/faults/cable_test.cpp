// A bus of 1 Mbit/s that loses, repeats, delays and reorders frames: the frames are counted, no
// channel trips, and the tracking error is measured.
#include <cmath>

#include "tests/faults/bad_cable.hpp"
#include "tests/faults/bench.hpp"

using namespace faults;

namespace {

/// RMS of the flexor's length error under length_control, mm.
double tracking_error_mm(Bench& bench, std::chrono::seconds time) {
  node::Wake wake;
  node::Reader<erp::ActuatorCommand> commands(bench.participant(), wake, 8);
  node::Reader<erp::SensorFrame> frames(bench.participant(), wake, 64);
  double commanded_m = 0, sum_m2 = 0;
  int count = 0;
  const auto end = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < end) {
    commands.take([&](const auto& m) {
      for (const auto& r : erp::samples(m.actuators))  // a frame without a new reading is skipped
        if (std::string(r.name) == "flexor") commanded_m = r.reference;
    });
    frames.take([&](const auto& m) {
      if (commanded_m == 0 || !(m.actuators._buffer[0].valid & erp::valid::line)) return;
      sum_m2 += std::pow(m.actuators._buffer[0].line_m - commanded_m, 2);
      ++count;
    });
    std::this_thread::sleep_for(1ms);
  }
  REQUIRE(count > 400);
  return 1e3 * std::sqrt(sum_m2 / count);
}

constexpr double tolerated_stall_ms = 2;  // chosen: one period

struct CableResult {
  int frames = 0, lost = 0, doubled = 0, trips = 0;
  double error_mm = 0, stall_ms = 0;
};

CableResult track(Bench& bench, BadCable& cable, const Impairment& impairment) {
  bench.settle();
  const int carried = cable.carried(), lost = cable.lost(), doubled = cable.doubled();
  const auto start_ns = node::wall_ns();
  cable.impair(impairment);
  CableResult result;
  result.error_mm = tracking_error_mm(bench, std::chrono::seconds(injections() / 3 + 3));
  result.stall_ms = cable.stall_ms();
  cable.impair({});
  for (const auto& message : bench.events().since(start_ns))
    result.trips += message.code == "ecu_fault";
  result.frames = cable.carried() - carried;
  result.lost = cable.lost() - lost;
  result.doubled = cable.doubled() - doubled;
  return result;
}

bool is_within_limits(const CableResult& result, double allowed_mm) {
  return result.trips == 0 && result.error_mm < allowed_mm;
}

/// Repeated up to three times if this machine stalled and a check failed: an ECU process then
/// applies an outdated duty, which a board does not. In one of the runs lost frames must be
/// reported.
CableResult track_without_stall(Bench& bench, BadCable& cable, const Impairment& impairment,
                                double allowed_mm) {
  const auto start_ns = node::wall_ns();
  for (int attempt = 1;; ++attempt) {
    const CableResult result = track(bench, cable, impairment);
    if (is_within_limits(result, allowed_mm) || result.stall_ms < tolerated_stall_ms ||
        attempt == 3) {
      if (impairment.lost > 0) CHECK(bench.events().first(start_ns, "lost_frames") != 0);
      return result;
    }
    std::printf("  (repeated: this machine stalled for %.0f ms)\n", result.stall_ms);
  }
}

}  // namespace

TEST_CASE(
    "on a 1 Mbit/s bus with loss, duplicates and delay no channel trips and tracking is within "
    "limits") {
  tests::Folder folder;
  write_rig(folder, 0.008);
  BadCable cable(Bench::host_bus_behind_cable(), Bench::bus());
  Bench bench(folder / "robot.xml", folder / "graph.xml", {}, Bench::host_bus_behind_cable());
  struct Case {
    const char* description;
    Impairment impairment;
  };
  const Case cases[] = {{"clean", {}},
                        {"10 % lost", {0.1}},
                        {"5 % duplicated", {0, 0.05}},
                        {"5 ms delay", {0, 0, 5}},
                        {"all three, jitter 1 ms", {0.1, 0.05, 5, 1}}};
  double allowed_mm = INFINITY;  // three times the error on a clean cable
  std::printf(
      "| on a 1 Mbit/s bus | frames | lost | duplicated | tracking error, mm RMS | trips |\n");
  for (const auto& [description, impairment] : cases) {
    const CableResult result = track_without_stall(bench, cable, impairment, allowed_mm);
    std::printf("| %-24s | %5d | %4d | %4d | %.3f | %d |\n", description, result.frames,
                result.lost, result.doubled, result.error_mm, result.trips);
    std::fflush(stdout);
    INFO(description);
    if (is_within_limits(result, allowed_mm) || result.stall_ms < tolerated_stall_ms) {
      CHECK(result.trips == 0);
      CHECK(result.error_mm < allowed_mm);
    } else tests::not_evaluated(std::string("a cable, ") + description + ": trips and tracking");
    CHECK((impairment.lost > 0) == (result.lost > 0));
    CHECK((impairment.doubled > 0) == (result.doubled > 0));
    if (allowed_mm == INFINITY) allowed_mm = 3 * result.error_mm;
  }
}
