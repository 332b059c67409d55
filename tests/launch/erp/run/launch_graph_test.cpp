// `erp launch` with real processes on a DDS domain of its own.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "launch/erp/run/process.hpp"

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// A graph of test components with its own folder and DDS domain.
struct Graph {
  fs::path folder;

  explicit Graph(const std::string& components = R"(<component name="worker"/>)") {
    std::string name = (fs::temp_directory_path() / "erp_graph_XXXXXX").string();
    folder = mkdtemp(name.data());
    std::ofstream(folder / "robot.xml") << R"(<robot name="tester"/>)";
    std::ofstream(folder / "graph.xml")
        << R"(<graph name="testing" robot="robot.xml">)" << components << "</graph>";
    setenv("ERP_COMPONENT_PATH", ERP_TEST_COMPONENTS, 1);
    setenv("ERP_DOMAIN", std::to_string(100 + getpid() % 100).c_str(), 1);
  }
  ~Graph() { fs::remove_all(folder); }

  launch::Process start(std::vector<std::string> arguments) const {
    std::vector<std::string> argv{ERP_BIN_DIR "/erp", "launch", (folder / "graph.xml").string(),
                                  "--out", (folder / "run").string()};
    argv.insert(argv.end(), arguments.begin(), arguments.end());
    return launch::Process(argv, (folder / "screen").string());
  }
  int run(std::vector<std::string> arguments) const {
    auto process = start(std::move(arguments));
    return wait_for(process);
  }
  static int wait_for(launch::Process& process) {
    for (;;) {
      if (const auto ending = process.poll()) return ending->code;
      usleep(2000);
    }
  }
  std::string screen() const { return text_of(folder / "screen"); }
  void wait_for_line(const std::string& line, std::size_t times = 1) const {
    const auto count = [&] {
      const auto text = screen();
      std::size_t n = 0;
      for (auto k = text.find(line); k != text.npos; k = text.find(line, k + 1)) ++n;
      return n;
    };
    while (count() < times) usleep(2000);
  }
  /// The pids of all processes with the folder of this graph on their command line.
  std::vector<pid_t> processes() const {
    std::vector<pid_t> found;
    for (const auto& entry : fs::directory_iterator("/proc")) {
      const auto name = entry.path().filename().string();
      if (!std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; }))
        continue;
      if (text_of(entry.path() / "cmdline").find(folder.string()) != std::string::npos)
        found.push_back(std::stoi(name));
    }
    return found;
  }
  pid_t pid_of(const std::string& component) const {
    for (const pid_t pid : processes())
      if (text_of("/proc/" + std::to_string(pid) + "/cmdline")
              .starts_with(std::string(ERP_TEST_COMPONENTS) + "/" + component))
        return pid;
    return -1;
  }
};

std::size_t position_in(const std::string& text, const std::string& part) {
  INFO(text);
  INFO(part);
  REQUIRE(text.find(part) != text.npos);
  return text.find(part);
}

/// The time stamp of the line `[stamp] [info] active: …` in the log of a component.
std::string time_of_activation(const std::string& log) {
  const auto line = log.rfind('\n', position_in(log, "] active:")) + 1;
  return log.substr(line, log.find(']', line) - line);
}

}  // namespace

TEST_CASE("a graph activates its components in order, runs for --for, and leaves no process") {
  const Graph graph(R"(<component name="worker"/><component name="logger"/>)");
  CHECK(graph.run({"--lockstep", "--for", "300ms"}) == 0);
  std::string previous_time;
  for (const char* name : {"logger", "plant", "worker", "sim"}) {
    const auto time =
        time_of_activation(text_of(graph.folder / "run" / (name + std::string(".log"))));
    CHECK(previous_time <= time);
    previous_time = time;
  }
  const auto screen = graph.screen();
  CHECK(position_in(screen, "all components are ready") <
        position_in(screen, "all components are active"));
  CHECK(position_in(screen, "all components are active") <
        position_in(screen, "the end of the run"));
  CHECK_THAT(screen, Contains("exit code 0"));
  CHECK(graph.processes().empty());
  for (const char* name : {"plant.log", "sim.log", "worker.log", "logger.log", "erp.log"})
    CHECK(fs::exists(graph.folder / "run" / name));
}

TEST_CASE("in real time a run lasts for --for although its device was restarted") {
  const Graph graph;
  auto launcher = graph.start({"--for", "2s"});
  graph.wait_for_line("all components are active");
  kill(graph.pid_of("sim"), SIGKILL);
  CHECK(Graph::wait_for(launcher) == 0);
  const auto screen = graph.screen();
  CHECK(position_in(screen, "sim: killed by signal 9") <
        position_in(screen, "2.00 s are over; stopping"));
  CHECK(graph.processes().empty());
}

TEST_CASE(
    "invalid settings of all components are reported before any process starts, with exit code 2") {
  const Graph graph(R"(<component name="worker"/><component name="logger"/>)");
  CHECK(graph.run({"--set", "worker.fault=yes", "--set", "sim.speed=2"}) == 2);
  const auto screen = graph.screen();
  CHECK_THAT(screen, Contains("worker: ") && Contains("fault=yes") && Contains("crash, refuse"));
  CHECK_THAT(screen, Contains("sim: ") && Contains("unknown parameter \"speed\""));
  CHECK_FALSE(fs::exists(graph.folder / "run"));
}

TEST_CASE("Ctrl-C stops a graph in order with exit code 0") {
  const Graph graph;
  auto launcher = graph.start({});
  graph.wait_for_line("all components are active");
  kill(launcher.pid(), SIGINT);
  CHECK(Graph::wait_for(launcher) == 0);
  CHECK_THAT(graph.screen(), Contains("interrupted; stopping"));
  CHECK(graph.processes().empty());
}

TEST_CASE("a killed component is restarted and the graph continues") {
  const Graph graph;
  auto launcher = graph.start({});
  graph.wait_for_line("all components are active");
  for (const char* name : {"worker", "plant", "sim"}) {
    kill(graph.pid_of(name), SIGKILL);
    graph.wait_for_line(std::string(name) + " is up", 2);
  }
  kill(launcher.pid(), SIGTERM);
  CHECK(Graph::wait_for(launcher) == 0);
  CHECK_THAT(graph.screen(), Contains("killed by signal 9 (Killed), restart 1 of 5"));
}

TEST_CASE("after a change of robot.xml no component is restarted, and the graph ends") {
  const Graph graph;
  auto launcher = graph.start({});
  graph.wait_for_line("all components are active");
  std::ofstream(graph.folder / "robot.xml") << R"(<robot name="tester"><!-- edited --></robot>)";
  kill(graph.pid_of("worker"), SIGKILL);
  CHECK(Graph::wait_for(launcher) == 2);
  CHECK_THAT(graph.screen(), Contains("worker: not started, because ") &&
                                 Contains("robot.xml has changed since the launch"));
  CHECK(graph.processes().empty());
}

TEST_CASE(
    "a component that crashes repeatedly ends the graph with exit code 1, and its log is printed") {
  const Graph graph;
  CHECK(graph.run({"--set", "worker.fault=crash"}) == 1);
  CHECK_THAT(graph.screen(), Contains("given up after 5 restarts") &&
                                 Contains("| worker: crash requested by fault=crash"));
  CHECK(graph.processes().empty());
}

TEST_CASE(
    "a component that rejects its parameters ends the graph with exit code 2 without a restart") {
  const Graph graph;
  CHECK(graph.run({"--set", "worker.fault=refuse"}) == 2);
  CHECK_THAT(graph.screen(), Contains("fault must be none") && !Contains("restart 1"));
  CHECK(graph.run({"--set", "worker.faul=none"}) == 2);
  CHECK_THAT(graph.screen(), Contains("fault"));
}

TEST_CASE("no process survives a killed launcher") {
  const Graph graph;
  auto launcher = graph.start({});
  graph.wait_for_line("all components are active");
  // kill() reaches the launcher only; Process::send would reach its group.
  kill(launcher.pid(), SIGKILL);
  while (!graph.processes().empty()) usleep(2000);
  SUCCEED();
}

TEST_CASE("a second Ctrl-C kills a component that does not stop") {
  const Graph graph;
  auto launcher = graph.start({"--set", "worker.fault=hang"});
  graph.wait_for_line("all components are active");
  kill(launcher.pid(), SIGINT);
  graph.wait_for_line("worker: stopping");
  kill(launcher.pid(), SIGINT);
  CHECK(Graph::wait_for(launcher) == 1);
  CHECK(graph.processes().empty());
}

TEST_CASE("a second graph for the same robot on the same bus is rejected with exit code 2") {
  const Graph graph;
  auto first = graph.start({});
  graph.wait_for_line("all components are active");
  launch::Process second({ERP_BIN_DIR "/erp", "launch", (graph.folder / "graph.xml").string(),
                          "--out", (graph.folder / "run2").string()},
                         (graph.folder / "screen2").string());
  CHECK(Graph::wait_for(second) == 2);
  CHECK_THAT(text_of(graph.folder / "screen2"), Contains("ERP_DOMAIN"));
  CHECK_THAT(text_of(graph.folder / "screen2"), !Contains("processes"));  // no process was started
  CHECK_THAT(graph.screen(), !Contains("already"));  // the first graph reports no conflict
  CHECK_FALSE(first.poll());
  kill(first.pid(), SIGINT);
  CHECK(Graph::wait_for(first) == 0);
}

TEST_CASE("bad input is rejected with exit code 2 before any process starts") {
  const Graph graph;
  CHECK(graph.run({"--device", "cam"}) == 2);
  CHECK_THAT(graph.screen(), Contains("sim, can or replay:FILE"));
  CHECK(graph.run({"--for", "20kg"}) == 2);
  CHECK(graph.run({"--set", "wroker.a=b"}) == 2);
  CHECK_THAT(graph.screen(), Contains("did you mean \"worker\"?"));
  CHECK_FALSE(fs::exists(graph.folder / "run"));
}

TEST_CASE("a launch whose components are not ready within --ready-timeout is stopped in order") {
  const Graph graph;
  CHECK(graph.run({"--ready-timeout", "1ms"}) == 1);
  CHECK_THAT(graph.screen(), Contains("not ready after 0.0 s: ") && Contains("worker"));
  CHECK(graph.processes().empty());
}

TEST_CASE("a --ready-timeout that is not a duration is rejected before the run folder is created") {
  const Graph graph;
  CHECK(graph.run({"--ready-timeout", "soon"}) == 2);
  CHECK_THAT(graph.screen(), Contains("\"soon\" is not a duration"));
  CHECK_FALSE(fs::exists(graph.folder / "run"));
}
