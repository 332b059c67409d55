#include <csignal>

#include "tests/launch/erp/run/supervisor_run.hpp"

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

TEST_CASE("stopping ends a component that was waiting to be restarted") {
  Run run;
  run.get_running();
  run.end(2, {1, 0});
  run.supervisor.stop("interrupted", 0, run.now_ns);
  run.wait(10 * s);
  CHECK(run.wanted() == Strings{"terminate plant", "kill plant"});
}
