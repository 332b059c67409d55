// `erp launch` as a person meets it: real processes, a bus of its own.
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

/// A graph of test components in a folder of its own, on a domain of its own.
struct Graph {
  fs::path folder;

  explicit Graph(const std::string& lines = R"(<component name="worker"/>)") {
    std::string name = (fs::temp_directory_path() / "erp_graph_XXXXXX").string();
    folder = mkdtemp(name.data());
    std::ofstream(folder / "robot.xml") << R"(<robot name="tester"/>)";
    std::ofstream(folder / "graph.xml")
        << R"(<graph name="testing" robot="robot.xml">)" << lines << "</graph>";
    setenv("ERP_COMPONENT_PATH", ERP_TEST_COMPONENTS, 1);
    setenv("ERP_DOMAIN", std::to_string(100 + getpid() % 100).c_str(), 1);
  }
  ~Graph() { fs::remove_all(folder); }

  launch::Process start(std::vector<std::string> words) const {
    std::vector<std::string> argv{ERP_BIN_DIR "/erp", "launch", (folder / "graph.xml").string(),
                                  "--out", (folder / "run").string()};
    argv.insert(argv.end(), words.begin(), words.end());
    return launch::Process(argv, (folder / "screen").string());
  }
  int run(std::vector<std::string> words) const {
    auto process = start(std::move(words));
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
      for (auto at = text.find(line); at != text.npos; at = text.find(line, at + 1)) ++n;
      return n;
    };
    while (count() < times) usleep(2000);
  }
  /// The pids of every process that has this graph's folder on its command line.
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

std::size_t at(const std::string& text, const std::string& part) {
  INFO(text);
  INFO(part);
  REQUIRE(text.find(part) != text.npos);
  return text.find(part);
}

/// The stamp of the line `[stamp] [info] active: …` in a component's log.
std::string time_of_activation(const std::string& log) {
  const auto line = log.rfind('\n', at(log, "] active:")) + 1;
  return log.substr(line, log.find(']', line) - line);
}

}  // namespace

TEST_CASE("a graph starts in order, runs as long as it was told, and leaves nothing behind") {
  const Graph graph(R"(<component name="worker"/><component name="logger"/>)");
  CHECK(graph.run({"--lockstep", "--for", "300ms"}) == 0);
  std::string before;
  for (const char* name : {"logger", "plant", "worker", "sim"}) {
    const auto time =
        time_of_activation(text_of(graph.folder / "run" / (name + std::string(".log"))));
    CHECK(before <= time);
    before = time;
  }
  const auto screen = graph.screen();
  CHECK(at(screen, "all components are ready") < at(screen, "all components are active"));
  CHECK(at(screen, "all components are active") < at(screen, "the end of the run"));
  CHECK_THAT(screen, Contains("exit code 0"));
  CHECK(graph.processes().empty());
  for (const char* name : {"plant.log", "sim.log", "worker.log", "logger.log", "erp.log"})
    CHECK(fs::exists(graph.folder / "run" / name));
}

TEST_CASE("in real time a run lasts as long as it was told, though the device was restarted") {
  const Graph graph;
  auto launcher = graph.start({"--for", "2s"});
  graph.wait_for_line("all components are active");
  kill(graph.pid_of("sim"), SIGKILL);
  CHECK(Graph::wait_for(launcher) == 0);
  const auto screen = graph.screen();
  CHECK(at(screen, "sim: killed by signal 9") < at(screen, "2.00 s are over; stopping"));
  CHECK(graph.processes().empty());
}

TEST_CASE("mistaken settings are all said before anything starts, with exit code 2") {
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

TEST_CASE("a killed component comes back and the graph goes on") {
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

TEST_CASE("a component that keeps crashing ends the graph with exit code 1 and shows its log") {
  const Graph graph;
  CHECK(graph.run({"--set", "worker.fault=crash"}) == 1);
  CHECK_THAT(graph.screen(),
             Contains("given up after 5 restarts") && Contains("| worker: crashing as told"));
  CHECK(graph.processes().empty());
}

TEST_CASE("a component that refuses its parameters ends the graph with exit code 2 at once") {
  const Graph graph;
  CHECK(graph.run({"--set", "worker.fault=refuse"}) == 2);
  CHECK_THAT(graph.screen(), Contains("fault must be none") && !Contains("restart 1"));
  CHECK(graph.run({"--set", "worker.faul=none"}) == 2);
  CHECK_THAT(graph.screen(), Contains("fault"));
}

TEST_CASE("nothing survives a launcher that is killed") {
  const Graph graph;
  auto launcher = graph.start({});
  graph.wait_for_line("all components are active");
  // Not through Process::send, which would reach the group: the launcher alone.
  kill(launcher.pid(), SIGKILL);
  while (!graph.processes().empty()) usleep(2000);
  SUCCEED();
}

TEST_CASE("a second Ctrl-C kills a component that hangs") {
  const Graph graph;
  auto launcher = graph.start({"--set", "worker.fault=hang"});
  graph.wait_for_line("all components are active");
  kill(launcher.pid(), SIGINT);
  graph.wait_for_line("worker: stopping");
  kill(launcher.pid(), SIGINT);
  CHECK(Graph::wait_for(launcher) == 1);
  CHECK(graph.processes().empty());
}

TEST_CASE("a graph is refused while another one drives the same robot on the same bus") {
  const Graph graph;
  auto first = graph.start({});
  graph.wait_for_line("all components are active");
  launch::Process second({ERP_BIN_DIR "/erp", "launch", (graph.folder / "graph.xml").string(),
                          "--out", (graph.folder / "run2").string()},
                         (graph.folder / "screen2").string());
  CHECK(Graph::wait_for(second) == 2);
  CHECK_THAT(text_of(graph.folder / "screen2"), Contains("ERP_DOMAIN"));
  CHECK_THAT(text_of(graph.folder / "screen2"), !Contains("processes"));  // none was started
  CHECK_THAT(graph.screen(), !Contains("already"));  // nor is the first one blamed
  CHECK_FALSE(first.poll());
  kill(first.pid(), SIGINT);
  CHECK(Graph::wait_for(first) == 0);
}

TEST_CASE("bad input is refused with exit code 2 before anything starts") {
  const Graph graph;
  CHECK(graph.run({"--device", "cam"}) == 2);
  CHECK_THAT(graph.screen(), Contains("sim, can or replay:FILE"));
  CHECK(graph.run({"--for", "20kg"}) == 2);
  CHECK(graph.run({"--set", "wroker.a=b"}) == 2);
  CHECK_THAT(graph.screen(), Contains("did you mean \"worker\"?"));
  CHECK_FALSE(fs::exists(graph.folder / "run"));
}

TEST_CASE("a launch whose components are not ready in time is given up, in order") {
  const Graph graph;
  CHECK(graph.run({"--patience", "1ms"}) == 1);
  CHECK_THAT(graph.screen(), Contains("not ready after 0.0 s: ") && Contains("worker"));
  CHECK(graph.processes().empty());
}

TEST_CASE("a patience that is no time is refused before anything is made") {
  const Graph graph;
  CHECK(graph.run({"--patience", "soon"}) == 2);
  CHECK_THAT(graph.screen(), Contains("\"soon\" is not a duration"));
  CHECK_FALSE(fs::exists(graph.folder / "run"));
}
