// Measures the latency from a sensor frame through controller and plant to the command at the
// device, with the real processes. In the same run, ddsperf measures the round trip of a message of
// the same size. Prints JSON.
//
// This program subscribes to the topics of the device. It receives the frame of the device at the
// same time as the plant, which then publishes the sensor frame. From that time to the arrival of
// the command there are three hops: sensor_frame, actuator_command, ecu_command. From the time
// stamp of the device there are four hops.
//
//   erp_latency [GRAPH.xml] [SECONDS]
#include <sys/wait.h>

#include <unistd.h>
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "components/node/bus.hpp"
#include "components/node/clock.hpp"

#include <poll.h>

namespace {

struct Quantiles {
  double p50_us = 0, p99_us = 0;
  std::size_t count = 0;
};

Quantiles quantiles(std::vector<double> us) {
  if (us.empty()) return {};
  std::sort(us.begin(), us.end());
  const auto quantile = [&](double probability) {
    return us[static_cast<std::size_t>(probability * static_cast<double>(us.size() - 1))];
  };
  return {quantile(0.5), quantile(0.99), us.size()};
}

pid_t start(const std::vector<std::string>& command, const std::string& output) {
  const pid_t pid = fork();
  if (pid) return pid;
  if (!freopen(output.c_str(), "w", stdout)) _exit(126);
  std::vector<char*> argv;
  for (const auto& argument : command) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execvp(argv[0], argv.data());
  _exit(127);
}

std::string content(const std::string& file) {
  std::FILE* in = std::fopen(file.c_str(), "r");
  std::string text;
  std::array<char, 4096> buffer;
  while (in) {
    const auto n = std::fread(buffer.data(), 1, buffer.size(), in);
    if (n == 0) break;
    text.append(buffer.data(), n);
  }
  if (in) std::fclose(in);
  return text;
}

/// Times of one frame of the device.
struct FrameTimes {
  std::int64_t stamped_ns, arrived_ns;
};
struct GraphLatency {
  Quantiles three_hops, four_hops;
};

/// Quantiles of all values but the first tenth, which belongs to the start of the run.
Quantiles quantiles_after_start(std::vector<double> us) {
  us.erase(us.begin(), us.begin() + static_cast<std::ptrdiff_t>(us.size() / 10));
  return quantiles(std::move(us));
}

/// Launches the graph and records the times of the device's frames and of the resulting commands.
GraphLatency measure_graph(const std::string& graph, const std::string& seconds,
                           const std::string& folder) {
  const auto participant = node::join("latency");
  node::Wake wake;
  node::Reader<erp::EcuFrame> frames(participant, wake, 64);
  node::Reader<erp::EcuCommand> commands(participant, wake, 64);
  const pid_t erp =
      start({ERP_BIN_DIR "/erp", "launch", graph, "--for", seconds + "s", "--out", folder + "/run"},
            folder + "/launch.txt");
  std::map<std::uint64_t, FrameTimes> pending_frames;
  std::vector<double> three_us, four_us;
  int status = 0;
  while (waitpid(erp, &status, WNOHANG) == 0) {
    pollfd waiting{wake.descriptor(), POLLIN, 0};
    poll(&waiting, 1, 100);
    wake.clear();
    frames.take([&](const erp::EcuFrame& frame) {
      pending_frames[frame.sequence] = {frame.stamp_ns, node::wall_ns()};
    });
    commands.take([&](const erp::EcuCommand& command) {
      const auto frame = pending_frames.find(command.answers);
      if (frame == pending_frames.end()) return;
      const auto now_ns = node::wall_ns();
      three_us.push_back(1e-3 * static_cast<double>(now_ns - frame->second.arrived_ns));
      four_us.push_back(1e-3 * static_cast<double>(now_ns - frame->second.stamped_ns));
      pending_frames.erase(pending_frames.begin(), std::next(frame));
    });
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) std::cerr << content(folder + "/launch.txt");
  return {quantiles_after_start(std::move(three_us)), quantiles_after_start(std::move(four_us))};
}

/// Round trip that ddsperf measures. It prints one line per second with half of the round trip; the
/// quantiles are the medians of these lines, doubled.
Quantiles measure_ddsperf(const std::string& seconds, int bytes, const std::string& folder) {
  const std::string domain = std::getenv("ERP_DOMAIN");
  const auto size = std::to_string(bytes);
  const auto pong =
      start({"ddsperf", "-i", domain, "-D", std::to_string(std::stoi(seconds) + 2), "pong"},
            folder + "/pong.txt");
  const auto ping = start({"ddsperf", "-i", domain, "-D", seconds, "ping", "500Hz", "size", size},
                          folder + "/ping.txt");
  waitpid(ping, nullptr, 0), waitpid(pong, nullptr, 0);
  const auto text = content(folder + "/ping.txt");
  const std::regex line(R"(50% ([0-9.]+)us .*99% ([0-9.]+)us)");
  std::vector<double> p50, p99;
  for (std::sregex_iterator it(text.begin(), text.end(), line), end; it != end; ++it)
    p50.push_back(2 * std::stod((*it)[1])), p99.push_back(2 * std::stod((*it)[2]));
  return {quantiles(p50).p50_us, quantiles(p99).p50_us, p50.size()};
}

void print(const char* name, const Quantiles& values) {
  std::printf("  \"%s\": {\"p50_us\": %.1f, \"p99_us\": %.1f, \"count\": %zu},\n", name,
              values.p50_us, values.p99_us, values.count);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string graph = argc > 1 ? argv[1] : ERP_SOURCE_DIR "/tests/bench/latency.xml";
  const std::string seconds = argc > 2 ? argv[2] : "10";
  setenv("ERP_DOMAIN", std::to_string(1 + getpid() % 200).c_str(), 0);
  auto folder = (std::filesystem::temp_directory_path() / "erp_latency_XXXXXX").string();
  if (!mkdtemp(folder.data())) return 1;
  const std::string loopback_file = folder + "/cyclonedds.xml";
  if (std::FILE* file = std::fopen(loopback_file.c_str(), "w")) {
    std::fputs(node::loopback_config(), file);
    std::fclose(file);
  }
  const auto graph_latency = measure_graph(graph, seconds, folder);
  setenv("CYCLONEDDS_URI", ("file://" + loopback_file).c_str(), 1);
  const auto round_trip = measure_ddsperf(seconds, 256, folder);
  std::printf("{\n");
  print("sensor_frame_to_command", graph_latency.three_hops);
  print("device_frame_to_command", graph_latency.four_hops);
  print("ddsperf_round_trip", round_trip);
  std::printf("  \"hops\": [3, 4, 2], \"bytes\": 256,\n");
  std::printf("  \"ratio_p50\": %.2f, \"ratio_p99\": %.2f,\n",
              graph_latency.three_hops.p50_us / round_trip.p50_us,
              graph_latency.three_hops.p99_us / round_trip.p99_us);
  std::printf("  \"ratio_from_device_p50\": %.2f, \"ratio_from_device_p99\": %.2f\n}\n",
              graph_latency.four_hops.p50_us / round_trip.p50_us,
              graph_latency.four_hops.p99_us / round_trip.p99_us);
  std::filesystem::remove_all(folder);
  return graph_latency.three_hops.count > 0 && round_trip.count > 0 ? 0 : 1;
}
