// A graph runs for half an hour while a process is killed every few seconds: all channels always
// run again, and the memory of the other processes does not grow. ERP_SOAK_MINUTES: duration (30).
#include <filesystem>
#include <map>
#include <random>

#include "tests/faults/bench.hpp"

using namespace faults;

namespace {

double resident_MB(pid_t pid) {
  std::ifstream statm("/proc/" + std::to_string(pid) + "/statm");
  double pages = 0, resident = 0;
  statm >> pages >> resident;
  return resident * double(::sysconf(_SC_PAGESIZE)) / 1e6;
}

/// A process that is not killed.
struct Survivor {
  pid_t pid;
  double first_fifth_MB = 0, end_MB = 0;
};

double soak_minutes() {
  const char* text = std::getenv("ERP_SOAK_MINUTES");
  return text ? std::atof(text) : 30;
}

void print(const std::map<std::string, std::vector<double>>& recovery_s) {
  std::printf("| killed | times | back to tracking after, s: p50 | p95 | max |\n");
  for (auto [victim, times] : recovery_s) {
    std::ranges::sort(times);
    const auto percentile = [&](double quantile) {
      return times[std::size_t(quantile * double(times.size() - 1))];
    };
    std::printf("| %-14s | %4zu | %.2f | %.2f | %.2f |\n", victim.c_str(), times.size(),
                percentile(0.5), percentile(0.95), percentile(1));
  }
}

}  // namespace

TEST_CASE("after random kills the graph always recovers, and memory does not grow") {
  const std::vector<std::string> victims{"gateway", "plant", "length_control", "sim", "ecu"};
  tests::Folder folder;
  write_rig(folder, 0.008);
  Bench bench(folder / "robot.xml", folder / "graph.xml");
  std::map<std::string, Survivor> survivors{{"erp", {bench.graph().pid()}},
                                            {"ecu", {bench.rack().pid()}},
                                            {"target", {bench.process("target")}}};
  std::map<std::string, std::vector<double>> recovery_s;
  int cleared = 0;
  std::mt19937 random(1);
  const auto start_ns = node::monotonic_ns();
  const auto minutes = [&] { return 1e-9 * double(node::monotonic_ns() - start_ns) / 60; };
  const double end = soak_minutes();
  for (double reported = 0; minutes() < end;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2000 + random() % 3000));
    const std::string victim = victims[random() % victims.size()];
    const auto killed_ns = node::monotonic_ns();
    ::kill(victim == "ecu" ? bench.ecu(0) : bench.process(victim), SIGKILL);
    std::this_thread::sleep_for(100ms);
    cleared += bench.settle();
    recovery_s[victim].push_back(1e-9 * double(node::monotonic_ns() - killed_ns));
    for (auto& [name, survivor] : survivors)
      (minutes() < end / 5 ? survivor.first_fifth_MB : survivor.end_MB) = resident_MB(survivor.pid);
    if (minutes() - reported < 1) continue;
    reported = minutes();
    std::printf("  %.0f of %.0f min\n", reported, end);
    std::fflush(stdout);
  }
  print(recovery_s);
  std::printf("faults cleared by operator command: %d\n", cleared);
  for (const auto& [name, survivor] : survivors) {
    std::printf("| %-8s | resident after a fifth %.2f MB | at the end %.2f MB |\n", name.c_str(),
                survivor.first_fifth_MB, survivor.end_MB);
    INFO(name);
    CHECK(survivor.end_MB < 1.05 * survivor.first_fifth_MB + 0.5);
  }
  for (const auto& [victim, times] : recovery_s) CHECK(std::ranges::max(times) < 10);
}
