#include <csignal>

#include "tests/launch/erp/run/supervisor_run.hpp"

TEST_CASE("when the device exits with 0 the run stops in reverse order") {
  Run run;
  run.complete_start();
  run.end(2);
  CHECK(run.actions() == Strings{"terminate plant"});
  run.wait(10 * ms);
  CHECK(run.actions().empty());
  run.end(1);
  CHECK(run.actions() == Strings{"terminate logger"});
  run.end(0);
  CHECK(run.supervisor.done());
  CHECK(run.supervisor.exit_code() == 0);
}

TEST_CASE("a stop terminates the device first and waits for each member") {
  Run run;
  run.complete_start();
  run.supervisor.stop("interrupted", 0, run.now_ns);
  CHECK(run.actions() == Strings{"terminate sim"});
  run.end(2, {0, SIGTERM});
  CHECK(run.actions() == Strings{"terminate plant"});
  run.end(1);
  run.end(0);
  CHECK(run.supervisor.done());
  CHECK(run.supervisor.exit_code() == 0);
}

TEST_CASE(
    "a stop continues when a component reports finalized, and is done when all processes have "
    "ended") {
  Run run;
  run.complete_start();
  run.supervisor.stop("interrupted", 0, run.now_ns);
  CHECK(run.actions() == Strings{"terminate sim"});
  run.heartbeat(2, Lifecycle::finalized);
  run.wait(1 * ms);
  CHECK(run.actions() == Strings{"terminate plant"});
  run.heartbeat(1, Lifecycle::finalized);
  run.wait(1 * ms);
  CHECK(run.actions() == Strings{"terminate logger"});
  run.end(0);
  CHECK_FALSE(run.supervisor.done());
  run.end(1);
  run.end(2);
  CHECK(run.supervisor.done());
}

TEST_CASE("a component that does not end after finalized is killed") {
  Run run;
  run.complete_start();
  run.supervisor.stop("interrupted", 0, run.now_ns);
  run.heartbeat(2, Lifecycle::finalized);
  run.actions();
  run.wait(5 * s);
  CHECK(run.actions() == Strings{"kill sim", "terminate plant"});
}

TEST_CASE("a component that does not stop within 5 s is killed, and the exit code is 1") {
  Run run;
  run.complete_start();
  run.supervisor.stop("interrupted", 0, run.now_ns);
  run.wait(4900 * ms);
  CHECK(run.actions() == Strings{"terminate sim"});
  run.wait(200 * ms);
  CHECK(run.actions() == Strings{"kill sim"});
  run.end(2, {0, SIGKILL});
  run.end(1);
  run.end(0);
  CHECK(run.supervisor.exit_code() == 1);
}

TEST_CASE("kill_now kills all processes at once") {
  Run run;
  run.complete_start();
  run.supervisor.stop("interrupted", 0, run.now_ns);
  run.actions();
  run.supervisor.kill_now();
  CHECK(run.actions() == Strings{"kill logger", "kill plant", "kill sim"});
  for (std::size_t i = 0; i < 3; ++i) run.end(i, {0, SIGKILL});
  CHECK(run.supervisor.done());
  CHECK(run.supervisor.exit_code() == 1);
}

TEST_CASE("a stop cancels the pending restart of a component") {
  Run run;
  run.complete_start();
  run.end(2, {1, 0});
  run.supervisor.stop("interrupted", 0, run.now_ns);
  run.wait(10 * s);
  CHECK(run.actions() == Strings{"terminate plant", "kill plant"});
}
