#include "launch/erp/supervisor.hpp"

#include <catch2/catch.hpp>
#include <csignal>
#include <string>

using erp::Lifecycle;
using launch::Action;
using launch::Ending;
using launch::Phase;
using launch::Stage;
using Strings = std::vector<std::string>;

namespace {

constexpr std::int64_t ms = 1'000'000, s = 1000 * ms;

/// A graph of three on paper: logger 0, plant 1, device 2.
struct Run {
  launch::Supervisor supervisor;
  std::int64_t now_ns = 1 * s;

  explicit Run(erp::Restart restart = erp::Restart::on_failure)
      : supervisor({{"logger", restart}, {"plant", restart}, {"sim", restart, true}}) {
    supervisor.start(now_ns);
  }

  /// What the supervisor wants done, as "verb name", words left out.
  Strings wanted() {
    static const Strings names{"logger", "plant", "sim"};
    Strings list;
    for (const auto& action : supervisor.take_actions()) {
      const auto& name = names[action.member];
      if (action.kind == Action::Kind::spawn) list.push_back("spawn " + name);
      if (action.kind == Action::Kind::activate) list.push_back("activate " + name);
      if (action.kind == Action::Kind::terminate) list.push_back("terminate " + name);
      if (action.kind == Action::Kind::kill) list.push_back("kill " + name);
    }
    return list;
  }
  void wait(std::int64_t duration_ns) {
    now_ns += duration_ns;
    supervisor.tick(now_ns);
  }
  void hear(std::size_t member, Lifecycle lifecycle, std::uint32_t peers = 3,
            std::uint32_t links = 4) {
    supervisor.heard(member, {lifecycle, peers, links}, now_ns);
  }
  void end(std::size_t member, Ending ending = {}) {
    supervisor.ended(member, ending, now_ns);
    supervisor.tick(now_ns);
  }
  void all(Lifecycle lifecycle) {
    for (std::size_t i = 0; i < 3; ++i) hear(i, lifecycle);
  }
  /// Through the whole start.
  void get_running() {
    all(Lifecycle::inactive);
    wait(300 * ms);
    all(Lifecycle::active);
    wait(1 * ms);
    wanted();
    REQUIRE(supervisor.stage() == Stage::running);
  }
};

}  // namespace

TEST_CASE("all processes are spawned at once") {
  Run run;
  CHECK(run.wanted() == Strings{"spawn logger", "spawn plant", "spawn sim"});
}

TEST_CASE("components are activated in order, each after the one before is active") {
  Run run;
  run.wanted();
  run.all(Lifecycle::inactive);
  run.wait(250 * ms);
  CHECK(run.wanted() == Strings{"activate logger"});
  run.wait(10 * ms);
  CHECK(run.wanted().empty());
  run.hear(0, Lifecycle::active);
  run.wait(10 * ms);
  CHECK(run.wanted() == Strings{"activate plant"});
  run.hear(1, Lifecycle::active);
  run.wait(10 * ms);
  CHECK(run.wanted() == Strings{"activate sim"});
  CHECK(run.supervisor.stage() == Stage::activating);
  run.hear(2, Lifecycle::active);
  run.wait(10 * ms);
  CHECK(run.supervisor.stage() == Stage::running);
}

TEST_CASE("nothing is activated while a component does not see every other process") {
  Run run;
  run.wanted();
  run.all(Lifecycle::inactive);
  run.hear(1, Lifecycle::inactive, 2);
  run.wait(5 * s);
  CHECK(run.wanted().empty());
  run.hear(1, Lifecycle::inactive, 3);
  run.wait(1 * ms);
  CHECK(run.wanted() == Strings{"activate logger"});
}

TEST_CASE("nothing is activated while links are still being made") {
  Run run;
  run.wanted();
  run.all(Lifecycle::inactive);
  run.wait(150 * ms);
  run.hear(2, Lifecycle::inactive, 3, 5);
  run.wait(150 * ms);
  CHECK(run.wanted().empty());
  run.hear(2, Lifecycle::inactive, 3, 5);
  run.wait(60 * ms);
  CHECK(run.wanted() == Strings{"activate logger"});
}

TEST_CASE("an activation that was not followed is sent again") {
  Run run;
  run.wanted();
  run.all(Lifecycle::inactive);
  run.wait(250 * ms);
  CHECK(run.wanted() == Strings{"activate logger"});
  run.wait(200 * ms);
  CHECK(run.wanted() == Strings{"activate logger"});
}

TEST_CASE("a start that does not come about is given up, and names who is missing") {
  Run run;
  run.wanted();
  run.hear(0, Lifecycle::inactive);
  run.wait(61 * s);
  std::string said;
  for (const auto& action : run.supervisor.take_actions()) said += action.text;
  CHECK(said.find("not ready after 60.0 s: plant, sim") != said.npos);
  CHECK(run.supervisor.stage() == Stage::stopping);
  CHECK(run.supervisor.exit_code() == 1);
}

TEST_CASE("when the device has ended by itself the run is over and ends in reverse order") {
  Run run;
  run.get_running();
  run.end(2);
  CHECK(run.wanted() == Strings{"terminate plant"});
  run.wait(10 * ms);
  CHECK(run.wanted().empty());
  run.end(1);
  CHECK(run.wanted() == Strings{"terminate logger"});
  run.end(0);
  CHECK(run.supervisor.done());
  CHECK(run.supervisor.exit_code() == 0);
}

TEST_CASE("an ordered stop begins with the device and waits for each") {
  Run run;
  run.get_running();
  run.supervisor.stop("interrupted", 0, run.now_ns);
  CHECK(run.wanted() == Strings{"terminate sim"});
  run.end(2, {0, SIGTERM});
  CHECK(run.wanted() == Strings{"terminate plant"});
  run.end(1);
  run.end(0);
  CHECK(run.supervisor.done());
  CHECK(run.supervisor.exit_code() == 0);
}

TEST_CASE("a stop goes on once a component has said its last word, and ends when all are gone") {
  Run run;
  run.get_running();
  run.supervisor.stop("interrupted", 0, run.now_ns);
  CHECK(run.wanted() == Strings{"terminate sim"});
  run.hear(2, Lifecycle::finalized);
  run.wait(1 * ms);
  CHECK(run.wanted() == Strings{"terminate plant"});
  run.hear(1, Lifecycle::finalized);
  run.wait(1 * ms);
  CHECK(run.wanted() == Strings{"terminate logger"});
  run.end(0);
  CHECK_FALSE(run.supervisor.done());
  run.end(1);
  run.end(2);
  CHECK(run.supervisor.done());
}

TEST_CASE("a component that does not end after its last word is killed too") {
  Run run;
  run.get_running();
  run.supervisor.stop("interrupted", 0, run.now_ns);
  run.hear(2, Lifecycle::finalized);
  run.wanted();
  run.wait(5 * s);
  CHECK(run.wanted() == Strings{"kill sim", "terminate plant"});
}

TEST_CASE("a component that does not stop is killed after a grace time, and the run has failed") {
  Run run;
  run.get_running();
  run.supervisor.stop("interrupted", 0, run.now_ns);
  run.wait(4900 * ms);
  CHECK(run.wanted() == Strings{"terminate sim"});
  run.wait(200 * ms);
  CHECK(run.wanted() == Strings{"kill sim"});
  run.end(2, {0, SIGKILL});
  run.end(1);
  run.end(0);
  CHECK(run.supervisor.exit_code() == 1);
}

TEST_CASE("a second interruption kills everything at once") {
  Run run;
  run.get_running();
  run.supervisor.stop("interrupted", 0, run.now_ns);
  run.wanted();
  run.supervisor.kill_now();
  CHECK(run.wanted() == Strings{"kill logger", "kill plant", "kill sim"});
  for (std::size_t i = 0; i < 3; ++i) run.end(i, {0, SIGKILL});
  CHECK(run.supervisor.done());
  CHECK(run.supervisor.exit_code() == 1);
}

TEST_CASE("a killed component is started again after a back-off and activated when ready") {
  Run run;
  run.get_running();
  run.end(1, {0, SIGKILL});
  run.wait(90 * ms);
  CHECK(run.wanted().empty());
  CHECK(run.supervisor.phase(1) == Phase::backing_off);
  run.wait(20 * ms);
  CHECK(run.wanted() == Strings{"spawn plant"});
  run.hear(1, Lifecycle::inactive);
  run.wait(250 * ms);
  CHECK(run.wanted() == Strings{"activate plant"});
  run.hear(1, Lifecycle::active);
  CHECK(run.supervisor.phase(1) == Phase::active);
  CHECK(run.supervisor.restarts(1) == 1);
  CHECK(run.supervisor.stage() == Stage::running);
}

TEST_CASE(
    "the back-off doubles up to its longest, and the sixth failure in the window ends the run") {
  Run run;
  run.get_running();
  for (const std::int64_t delay_ns : {100 * ms, 200 * ms, 400 * ms, 800 * ms, 1600 * ms}) {
    run.end(1, {1, 0});
    run.wait(delay_ns - 1);
    CHECK(run.wanted().empty());
    run.wait(1);
    CHECK(run.wanted() == Strings{"spawn plant"});
  }
  run.end(1, {1, 0});
  CHECK(run.supervisor.phase(1) == Phase::failed);
  CHECK(run.supervisor.stage() == Stage::stopping);
  CHECK(run.supervisor.exit_code() == 1);
}

TEST_CASE("failures far apart never end the run") {
  Run run;
  run.get_running();
  for (int i = 0; i < 20; ++i) {
    run.end(1, {1, 0});
    run.wait(100 * ms);
    CHECK(run.wanted() == Strings{"spawn plant"});
    run.wait(31 * s);
  }
  CHECK(run.supervisor.stage() == Stage::running);
}

TEST_CASE("restart=never: a failure ends the run, a clean exit does not") {
  Run failing(erp::Restart::never);
  failing.get_running();
  failing.end(1, {1, 0});
  CHECK(failing.supervisor.stage() == Stage::stopping);
  CHECK(failing.supervisor.exit_code() == 1);

  Run ending(erp::Restart::never);
  ending.get_running();
  ending.end(1);
  CHECK(ending.supervisor.stage() == Stage::running);
  CHECK(ending.supervisor.phase(1) == Phase::ended);
}

TEST_CASE("restart=always: even a clean exit is started again") {
  Run run(erp::Restart::always);
  run.get_running();
  run.end(1);
  CHECK(run.supervisor.phase(1) == Phase::backing_off);
}

TEST_CASE("a component that cannot use its input is not started again; the exit code says so") {
  Run run(erp::Restart::always);
  run.wanted();
  run.end(1, {2, 0});
  CHECK(run.supervisor.phase(1) == Phase::failed);
  CHECK(run.supervisor.exit_code() == 2);
  CHECK(run.wanted() == Strings{"terminate sim"});
}

TEST_CASE("stopping ends a component that was waiting to be restarted") {
  Run run;
  run.get_running();
  run.end(2, {1, 0});
  run.supervisor.stop("interrupted", 0, run.now_ns);
  run.wait(10 * s);
  CHECK(run.wanted() == Strings{"terminate plant", "kill plant"});
}
