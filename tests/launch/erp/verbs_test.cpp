// The verbs that inspect a running bus, with real components.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "launch/erp/run/process.hpp"

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

/// A `sim` that publishes the clock and a `worker` that subscribes to it. Both run without launcher
/// on a DDS domain of their own.
struct Bus {
  fs::path folder;
  launch::Process sim, worker;

  Bus()
      : folder(make_folder()),
        sim({ERP_TEST_COMPONENTS "/sim", "--robot", robot()}, (folder / "sim.log").string()),
        worker({ERP_TEST_COMPONENTS "/worker", "--name", "listener", "--robot", robot()},
               (folder / "worker.log").string()) {}
  ~Bus() { fs::remove_all(folder); }

  static fs::path make_folder() {
    setenv("ERP_DOMAIN", std::to_string(1 + getpid() % 99).c_str(), 1);
    std::string name = (fs::temp_directory_path() / "erp_verbs_XXXXXX").string();
    return mkdtemp(name.data());
  }
  std::string robot() const {
    const auto file = folder / "robot.xml";
    std::ofstream(file) << R"(<robot name="tester"/>)";
    return file.string();
  }
  struct Result {
    int code;
    std::string text;
  };
  Result erp(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), ERP_BIN_DIR "/erp");
    const auto log = folder / ("out" + std::to_string(++runs_));
    launch::Process process(arguments, log.string());
    for (;;) {
      if (const auto ending = process.poll()) {
        std::ostringstream text;
        text << std::ifstream(log).rdbuf();
        return {ending->code, text.str()};
      }
      usleep(2000);
    }
  }

 private:
  mutable int runs_ = 0;
};

}  // namespace

TEST_CASE("echo, ps, ls, graph, hz and delay show a running bus") {
  const Bus bus;
  // the first verb waits for discovery
  const auto echo = bus.erp({"echo", "clock", "-n", "2"});
  CHECK(echo.code == 0);
  CHECK_THAT(echo.text, Contains("real_time_factor: 1\n") && Contains("finished: false\n---\n"));

  const auto ps = bus.erp({"ps"});
  CHECK(ps.code == 0);
  CHECK_THAT(ps.text, Contains("sim") && Contains("listener") && Contains("active"));

  const auto ls = bus.erp({"ls"});
  CHECK_THAT(ls.text, Contains("clock") && Contains("erp::Clock") && Contains("component_state") &&
                          !Contains("erp ls"));

  const auto graph = bus.erp({"graph"});
  CHECK_THAT(graph.text, Contains("\"sim\" -> \"/clock\"") &&
                             Contains("\"/clock\" -> \"listener\"") &&
                             !Contains("component_state"));

  const auto hz = bus.erp({"hz", "clock", "--for", "1500ms"});
  CHECK(hz.code == 0);
  CHECK_THAT(hz.text, Contains("Hz") && Contains("p99"));

  const auto heartbeat_age = bus.erp({"delay", "component_state", "--for", "1500ms"});
  CHECK(heartbeat_age.code == 0);
  CHECK_THAT(heartbeat_age.text, Contains("p50") && Contains("messages"));

  const auto simulated_age = bus.erp({"delay", "clock", "--for", "1500ms"});
  CHECK_THAT(simulated_age.text, Contains("simulated time"));
}

TEST_CASE("an unknown topic ends with exit code 1 and the most similar name") {
  const Bus bus;
  const auto result = bus.erp({"echo", "clokc"});
  CHECK(result.code == 1);
  CHECK_THAT(result.text, Contains("did you mean \"clock\"?"));
}

TEST_CASE("a recording that does not exist ends with exit code 2 and its name") {
  const Bus bus;
  const auto result = bus.erp({"log", "info", "none.mcap"});
  CHECK(result.code == 2);
  CHECK_THAT(result.text, Contains("none.mcap: cannot open"));
}

TEST_CASE("a component without --robot ends with exit code 2 and names the option") {
  const auto folder = Bus::make_folder();
  launch::Process worker({ERP_TEST_COMPONENTS "/worker"}, (folder / "log").string());
  std::optional<launch::Ending> ending;
  while (!(ending = worker.poll())) usleep(2000);
  CHECK(ending->code == 2);
  std::ostringstream text;
  text << std::ifstream(folder / "log").rdbuf();
  CHECK_THAT(text.str(), Contains("--robot"));
  fs::remove_all(folder);
}

TEST_CASE("erp gap monitor runs the component with its options and exit codes") {
  const Bus bus;
  const auto help = bus.erp({"gap", "monitor", "--help"});
  CHECK(help.code == 0);
  CHECK_THAT(help.text, Contains("gap_monitor: a component") && Contains("window_s"));
  const auto checked =
      bus.erp({"gap", "monitor", "--robot", bus.robot(), "--set", "consecutive=0", "--check"});
  CHECK(checked.code == 2);
  CHECK_THAT(checked.text, Contains("consecutive"));
}

TEST_CASE("an unknown verb ends with exit code 2 and the most similar name") {
  const Bus bus;
  const auto result = bus.erp({"lunch"});
  CHECK(result.code == 2);
  CHECK_THAT(result.text, Contains("did you mean \"launch\"?"));
}

TEST_CASE("erp without a verb lists the verbs by purpose") {
  const Bus bus;
  const auto result = bus.erp({});
  CHECK(result.code == 0);
  CHECK_THAT(result.text, Contains("Inspect a running graph") && Contains("launch") &&
                              Contains("erp VERB --help"));
}

TEST_CASE("erp help prints the attributes of robot.xml and rejects an unknown format") {
  const Bus bus;
  const auto robot = bus.erp({"help", "robot"});
  CHECK(robot.code == 0);
  CHECK_THAT(robot.text, Contains("resistance_ohm"));
  const auto unknown = bus.erp({"help", "robt"});
  CHECK(unknown.code == 2);
  CHECK_THAT(unknown.text, Contains("did you mean \"robot\"?"));
}

TEST_CASE("every verb has a help text") {
  const Bus bus;
  for (const char* verb :
       {"launch", "check", "ps", "ls", "hz", "echo", "delay", "graph", "new", "help"}) {
    INFO(verb);
    const auto help = bus.erp({verb, "--help"});
    CHECK(help.code == 0);
    CHECK_THAT(help.text, Contains("Usage: erp " + std::string(verb)));
  }
}
